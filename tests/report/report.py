"""What both tests of the report share: a page made by the command as a user gives it, and a way to be skipped that ctest sees."""
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
    """A whole test that cannot run here is no pass."""
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def copy_committed(directory):
    """The committed results, in a directory of the test's own."""
    shutil.copytree(ROOT / "results", directory, ignore=shutil.ignore_patterns("oracle", "logs", "fields", "report.html"))


def make_report(directory, environment=ENVIRONMENT, **options):
    return subprocess.run([sys.executable, str(ROOT / "plots" / "make_report.py"), "--results", str(directory), "--environment", str(environment)], capture_output=True, text=True, timeout=150, **options)


def run_tests(module):
    """unittest.main, but a run in which tests were skipped and none failed is skipped as a whole."""
    program = unittest.main(module, exit=False, verbosity=2)
    if not program.result.wasSuccessful() or program.result.testsRun == 0:
        sys.exit(1)
    sys.exit(SKIPPED if program.result.skipped else 0)
