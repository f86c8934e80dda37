"""The formulas of the literature: beams, foundations and contact terms, summed over the pairs (`plain_sum`) or coupled.

Each source is one file; `slices` cuts helical teeth into thin spur gears.
"""
