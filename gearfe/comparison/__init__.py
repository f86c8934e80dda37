"""Evaluation of stiffness curves: comparison by zone, tables of cases, user-defined models.

Each evaluation is one file. Its result has tables in text form.
"""
