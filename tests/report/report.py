"""The part that all tests of the report share.

It runs the commands as a user gives them, and skips a test in a way that ctest sees.
"""
import csv
import os
import pathlib
import shutil
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
ENVIRONMENT = os.environ.get("DSS_REPORT_ENVIRONMENT", str(ROOT / "build" / "report-environment"))
SKIPPED = 77  # CMakeLists.txt: SKIP_RETURN_CODE


def skip_all(reason):
    """Ends a test that cannot run here; it does not count as passed."""
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def copy_committed(directory):
    """Copies the committed results to a directory of the test."""
    unused = shutil.ignore_patterns("oracle", "logs", "fields", "report.html")
    shutil.copytree(ROOT / "results", directory, ignore=unused)


def leave_out_empty_columns(directory):
    """Removes columns that are empty in every row from all tables, as the program does."""
    for path in (directory / "tables").glob("*.csv"):
        with open(path, encoding="utf-8", newline="") as file:
            head, *rows = csv.reader(file)
        kept = [place for place in range(len(head)) if any(row[place] for row in rows)]
        with open(path, "w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerows([row[place] for place in kept] for row in (head, *rows))


def run(*command, timeout_s=150):
    """Runs a program of plots/ with its arguments."""
    return subprocess.run([sys.executable, ROOT / "plots" / command[0], *command[1:]],
                          capture_output=True, text=True, timeout=timeout_s)


def make_report(directory, environment=ENVIRONMENT):
    """Runs make_report.py on a directory of results."""
    return run("make_report.py", "--results", directory, "--environment", environment)


def make_plots(directory):
    """Runs make_plots.py on a directory of results."""
    return run("make_plots.py", "--results", directory, timeout_s=900)


def run_tests(module):
    """Runs all tests of a module. If some were skipped and none failed, the run is skipped."""
    program = unittest.main(module, exit=False, verbosity=2)
    if not program.result.wasSuccessful() or program.result.testsRun == 0:
        sys.exit(1)
    sys.exit(SKIPPED if program.result.skipped else 0)
