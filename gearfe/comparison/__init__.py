"""Evaluation of stiffness curves: comparison by zone, tables of cases, user-defined models.

Each study is one file and returns a result that can print itself.
"""
