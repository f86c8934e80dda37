"""Questions asked of many curves: comparison by zone, case tables, models of the user's own.

Each study is one file and returns a result that can print itself.
"""
