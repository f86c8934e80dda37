"""Formulas of the literature: beam, foundation and contact terms, with independent tooth pairs (`plain_sum`) or coupled teeth.

Each source is one file; `slices` cuts helical teeth into thin spur gears.
"""
