"""Runs the checks of examples/reframe by ReFrame itself: with speeds that are met, and not met."""
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import venv

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = pathlib.Path(os.environ["DSSBENCH"]).resolve()
SKIPPED = 77  # CMakeLists.txt: SKIP_RETURN_CODE
CELL = {"scene": "plate_paper", "set": "n=100", "variant": "scalar", "threads": "1", "ranks": "1",
        "model": "spatial", "precision": "f64", "integrator": "rk4", "status": "ok"}


class Checks(unittest.TestCase):
    """ReFrame 4 in an environment of its own."""

    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory(prefix="dssbench-reframe-")
        cls.addClassCleanup(holder.cleanup)
        cls.folder = pathlib.Path(holder.name)
        venv.create(cls.folder / "venv", with_pip=True)
        pip = [cls.folder / "venv/bin/pip", "install", "--quiet", "ReFrame-HPC>=4.8,<5"]
        result = subprocess.run(pip, capture_output=True, text=True, check=False)
        if result.returncode:
            print(f"skipped: pip cannot install ReFrame here: {result.stderr}")
            sys.exit(SKIPPED)

    def run_checks(self, rate, *options):
        """{name of a check: (result, phase that failed)}. rate: reference [element-steps/s]"""
        table, report = self.folder / "table.csv", self.folder / "report.json"
        with open(table, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, [*CELL, "element_steps_per_s"])
            writer.writeheader()
            writer.writerow({**CELL, "element_steps_per_s": rate})
        report.unlink(missing_ok=True)
        result = subprocess.run(
            [self.folder / "venv/bin/reframe", "--prefix", self.folder / "runs", "--report-file",
             report, "-c", ROOT / "examples/reframe/dssbench_check.py", "-r", *options],
            capture_output=True, text=True, check=False, cwd=self.folder, env={
                **os.environ, "DSSBENCH_REFERENCES": str(table), "HOME": str(self.folder),
                "PATH": f"{PROGRAM.parent}:{os.environ['PATH']}"})
        self.assertTrue(report.exists(), result.stdout + result.stderr)
        cases = json.loads(report.read_text(encoding="utf-8"))["runs"][0]["testcases"]
        return {case["display_name"]: (case["result"], case["fail_phase"]) for case in cases}

    def test_sound_states_pass(self):
        results = self.run_checks(1.0, "-n", "StatesOfTheOracle", "-S",
                                  "executable_opts=verify,two_elements,--quiet,--device,none")
        self.assertEqual(set(results.values()), {("pass", None)})

    def test_a_speed_that_is_met_passes(self):
        results = self.run_checks(1.0, "-n", "SpeedOfAVariant.*scalar$")
        self.assertEqual(set(results.values()), {("pass", None)})

    def test_a_speed_that_is_not_met_fails(self):
        results = self.run_checks(1e15, "-n", "SpeedOfAVariant.*scalar$")
        self.assertEqual(set(results.values()), {("fail", "performance")})

    def test_a_variant_without_a_reference_fails(self):
        results = self.run_checks(1.0, "-n", "SpeedOfAVariant.*avx2")
        self.assertLessEqual(set(results.values()), {("fail", "performance"), ("skip", None)})


if __name__ == "__main__":
    unittest.main()
