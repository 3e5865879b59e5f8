"""A directory of results, as charts and the report read it.

Modules: tables, ages of records, and numbers as words.
"""
