"""Advice: text and JSON of the command, its errors, and the study that judges it."""
import csv
import json
import shlex
import unittest

from program import ProgramTest, dssbench

BEAM = ("advise", "cantilever_beam", "--set", "n=6", "--end", 0.02, "--saved-times", 4)

# A chain of elements without bending stiffness. It starts level and falls.
PENDULUM = {
    "scene": "pendulum",
    "title": "A pendulum of four parts",
    "bodies": [{"name": "chain", "geometry": {"box": [4, 1, 1]}, "element": 0.1,
                "constants": {"law": "paper", "k": 1e4, "d": 0, "kt": 0, "dt": 0, "mass": 1,
                              "inertia": 0.01}}],
    "clamps": [{"select": {"elements": [[0, 0, 0]]}}],
    "gravity": [0, 0, -9.81],
    "run": {"dt": 2e-3, "steps": 1000},
    "verify": {"steps": 10},
    "tolerance": {"f64": {"evaluation": 1e-13, "run": 1e-3},
                  "f32": {"evaluation": 1e-5, "run": 1e-3}},
}


class Advise(ProgramTest):
    def test_what_is_advised_can_be_run_as_printed(self):
        result = dssbench(*BEAM, "--tolerance", "1e-4", "--json", self.path("advice.json"),
                          "--verbose")
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

    def test_chaos_is_said_and_not_guessed_at(self):
        scene = self.write("pendulum.json", json.dumps(PENDULUM))
        result = dssbench("advise", scene, "--end", 1, "--tolerance", "1e-4")
        self.assertEqual(result.returncode, 0, result.stderr)
        result = dssbench("advise", scene, "--end", 40, "--tolerance", "1e-4",
                          "--budget", 300)
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertIn("amplifies", result.stderr)
        self.assertNotIn("dssbench run", result.stdout)

    def test_a_grid_is_chosen_where_a_parameter_refines_it(self):
        beam = ("advise", "cantilever_beam", "--set", "n=12", "--end", 0.1, "--saved-times", 4,
                "--vary")
        result = dssbench(*beam, "n", "--tolerance", "0.2", "--json", "-")
        self.assertEqual(result.returncode, 0, result.stderr)
        advice = json.loads(result.stdout)
        grid = advice["grid"]
        self.assertLessEqual(grid["error"], 0.1)
        self.assertGreater(grid["observed_order"], 0.5)
        self.assertEqual(advice["elements"], grid["value"])
        self.assertIn(f"--set n={grid['value']}", advice["chosen"]["command"])
        self.assertLessEqual(grid["error"] + advice["chosen"]["error_estimate"], 0.2)
        coarser = [run for run in grid["grids"] if run["value"] < grid["value"]]
        self.assertTrue(all(run["error"] > 0.1 for run in coarser), grid)
        self.assert_refused(2, ["--vary m", "no such parameter"], *beam, "m", "--tolerance", "1e-2")
        self.assert_refused(2, ["--vary E", "number of elements"], *beam, "E", "--tolerance",
                            "1e-2")
        self.assert_refused(2, ["stress"], *beam, "n", "--tolerance", "1e-2", "--quantity",
                            "stress")

    def study(self, **changes):
        work = {"solution": {"tolerance": 1e-9}, "tolerances": [1e-2, 1e-5],
                "scenes": [{"scene": "chain", "set": {"n": 6}, "end_time": 2e-4, "saved_times": 4}]}
        whole = {
            "experiment": "judged", "title": "Judged", "advise": {**work, **changes},
            "scales": {"smoke": {}}
        }
        return self.write("judged.json", json.dumps(whole))

    def test_a_study_holds_advice_against_the_oracle_and_everything(self):
        result = dssbench("experiment", self.study(), "--scale", "smoke", "--out", self.path("out"))
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(self.path("out/tables/judged.csv"), encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([float(row["tolerance"]) for row in rows], [1e-2, 1e-5])
        for row in rows:
            self.assertEqual(row["status"], "ok")
            self.assertLessEqual(float(row["true_error"]), float(row["tolerance"]))
            self.assertLessEqual(float(row["cheapest_true_error"]), float(row["tolerance"]))
            self.assertGreater(int(row["brute_force_runs"]), 10)
            over = float(row["time_over_cheapest"])  # any: the machine may be busy
            self.assertEqual(row["verdict"], "ok" if over <= 1.5 else "slower")

    def test_a_study_that_is_wrong_is_refused(self):
        for change, words in (
            ({"tolerances": [0]}, ["/advise/tolerances", "positive"]),
            ({"tolerances": []}, ["/advise/tolerances", "at least one"]),
            (
                {"scenes": [{"scene": "chian", "end_time": 1, "saved_times": 4}]},
                ["/advise/scenes/0", "chain"],
            ),
            (
                {
                    "scenes": [
                        {"scene": "chain", "end_time": 1, "saved_times": 4, "quantity": "strain"}
                    ]
                },
                ["quantity", "stress"],
            ),
        ):
            self.assert_refused(2, words, "experiment", self.study(**change), "--scale", "smoke",
                                "--out", self.path("out"))

    def test_bad_input_is_refused_in_one_line(self):
        self.assert_refused(2, ["--tolerance -1"], *BEAM, "--tolerance", "-1")
        self.assert_refused(2, ["--quantity strain", "stress"], *BEAM, "--tolerance", "1e-2",
                            "--quantity", "strain")
        self.assert_refused(2, ["--end 0"], "advise", "chain", "--tolerance", "1e-2", "--end", "0")
        self.assert_refused(2, ["--budget"], *BEAM, "--tolerance", "1e-2", "--budget", "0")
        self.assert_refused(2, ["avx1024"], *BEAM, "--tolerance", "1e-2", "--variant", "avx1024")
        self.assert_refused(2, ["--tolerance"], "advise", "chain")


if __name__ == "__main__":
    unittest.main()
