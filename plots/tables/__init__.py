"""A directory of results as charts and the report read it: tables, ages of
records, numbers as words."""
