"""Advice: what the command says, as text and JSON, and its errors."""
import json
import shlex
import unittest

from program import ProgramTest, dssbench

BEAM = ("advise", "cantilever_beam", "--set", "n=6", "--end", 0.02, "--saved-times", 4)


class Advise(ProgramTest):
    def test_what_is_advised_can_be_run_as_printed(self):
        result = dssbench(*BEAM, "--tolerance", "1e-4", "--json", self.path("advice.json"), "--verbose")
        self.assertEqual(result.returncode, 0, result.stderr)
        advice = json.loads(self.read("advice.json"))
        chosen = advice["chosen"]
        self.assertLessEqual(chosen["error_estimate"], 1e-4)
        self.assertIn(chosen["command"], result.stdout)
        self.assertIn("the paper's", result.stdout)
        self.assertEqual(advice["paper"]["model"], "spatial")
        self.assertEqual(advice["paper"]["integrator"], "rk4")
        self.assertGreater(advice["speedup_over_paper"], 0)
        self.assertIn("planar", advice["left_out"])
        for other in advice["others"]:
            self.assertTrue(other["reason"], other)
        run = dssbench(*shlex.split(chosen["command"])[1:], "--json", "-")
        self.assertEqual(run.returncode, 0, run.stderr)
        record = json.loads(run.stdout)
        for key in ("model", "integrator", "precision", "variant", "threads"):
            self.assertEqual(record[key], chosen[key])
        self.assertAlmostEqual(record["steps"] * record["dt_s"], 0.02, places=9)

    def test_json_alone_on_standard_output(self):
        result = dssbench(*BEAM, "--tolerance", "1e-2", "--quantity", "energy", "--json", "-")
        self.assertEqual(result.returncode, 0, result.stderr)
        advice = json.loads(result.stdout)
        self.assertEqual(advice["quantity"], "energy")
        self.assertIn("total energy", advice["measure"])

    def test_a_tolerance_below_rounding_names_the_least(self):
        result = dssbench(*BEAM, "--tolerance", "1e-18")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertIn("least tolerance", result.stderr)

    def test_a_budget_too_small_is_said(self):
        result = dssbench(*BEAM, "--tolerance", "1e-8", "--budget", "1e-9")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("--budget", result.stderr)

    def test_bad_input_is_refused_in_one_line(self):
        self.assert_refused(2, ["--tolerance -1"], *BEAM, "--tolerance", "-1")
        self.assert_refused(2, ["--quantity strain", "stress"], *BEAM, "--tolerance", "1e-2", "--quantity", "strain")
        self.assert_refused(2, ["--end 0"], "advise", "chain", "--tolerance", "1e-2", "--end", "0")
        self.assert_refused(2, ["--budget"], *BEAM, "--tolerance", "1e-2", "--budget", "0")
        self.assert_refused(2, ["avx1024"], *BEAM, "--tolerance", "1e-2", "--variant", "avx1024")
        self.assert_refused(2, ["--tolerance"], "advise", "chain")


if __name__ == "__main__":
    unittest.main()
