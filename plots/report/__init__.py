"""The report of a directory of results: report.html, one page that needs no network, and REPORT.md.

plots/make_report.py writes both.
"""
