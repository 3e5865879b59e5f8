"""Studies of precision: points with errors and times, points that fail, error budgets."""
import csv
import json
import os
import unittest

from program import ProgramTest, dssbench

BLOCK = {
    "scene": "plate_paper",
    "set": {"n": 6},
    "variants": ["reference", "auto"],
    "precisions": ["f64", "f32"],
    "integrators": ["rk4"],
    "accuracy": {"end_time": 1e-4, "saved_times": 4, "halvings": [-1, 0, 2], "dt": [1e-6]},
}
RULES = {
    "solution": {"tolerance": 1e-10},
    "tolerances": [1e-2, 1e-30],
    "comparisons": [{
        "scene": "plate_paper", "space": "plate", "contender": {
            "integrator": "rk4", "precision": "f32"
        }, "base": {"integrator": "rk4", "precision": "f64", "dt": 1e-6}
    }],
}
SCALE = {
    "repetitions": [2, 2], "retries": 0, "repeat_for": 0.005, "budget_s": 60, "time_limit_s": 20
}
BUDGET = {
    "experiment": "error_budget",
    "title": "Errors",
    "error_budget": {
        "solution": {"tolerance": 1e-9},
        "scenes": [{
            "label": "plate", "scene": "plate_paper", "set": {"n": 4}, "end_time": 1e-4,
            "saved_times": 4, "precisions": ["f64", "f32"], "models": ["planar"], "refinement": {
                "grids": [{"n": 4}, {"n": 8}, {"n": 16}], "keeps": "the constants of an element"
            }
        }],
    },
    "scales": {"smoke": {}},
}


class Precision(ProgramTest):
    def study(self, name="points", **changes):
        whole = {
            "experiment": name, "title": "Points", "cells": [BLOCK], "work_precision": RULES,
            "scales": {"smoke": SCALE}
        }
        return self.write(f"{name}.json", json.dumps({**whole, **changes}))

    def experiment(self, name="points", *arguments):
        return dssbench("experiment", self.path(f"{name}.json"), "--scale", "smoke", "--out",
                        self.path("out"), *arguments)

    def rows(self, name):
        with open(self.path(f"out/{name}.csv"), encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_points_have_errors_and_times_and_what_fails_stays(self):
        self.study()
        self.write("error_budget.json", json.dumps(BUDGET))
        budget = self.experiment("error_budget")
        self.assertEqual(budget.returncode, 0, budget.stderr)
        errors = {row["source"]: row for row in self.rows("tables/error_budget")}
        self.assertEqual(
            list(errors),
            [
                "time", "time at the stability limit", "space", "rounding f64", "rounding f32",
                "model planar"
            ],
        )
        self.assertLess(float(errors["time"]["error"]),
                        float(errors["time at the stability limit"]["error"]))
        self.assertLess(float(errors["rounding f64"]["error"]),
                        1e-6 * float(errors["rounding f32"]["error"]))
        self.assertIn("times that step is stable", budget.stdout)
        result = self.experiment()
        self.assertEqual(result.returncode, 0, result.stderr)
        table = self.rows("tables/points")
        self.assertEqual(len(table), 2 * 2 * 4)
        for row in table:
            if row["status"] == "refused":
                self.assertIn("stability limit", row["reason"])
                self.assertEqual((row["measured_wall_s"], row["pareto"]), ("", ""))
                continue
            self.assertEqual((row["status"], row["repetitions"], row["below_reference"]),
                             ("ok", "2", "no"))
            self.assertGreater(float(row["error_max"]), float(row["reference_error"]))
            self.assertEqual(float(row["evaluations"]), 4 * 36 * int(row["steps"]))
        self.assertEqual([row["status"] for row in table].count("refused"), 4)
        by_step = {
            row["dt_s"]: float(row["error_max"])
            for row in table
            if row["variant"] == "reference" and row["precision"] == "f64" and row["error_max"]
        }
        self.assertEqual(sorted(by_step.values()),
                         [by_step[step] for step in sorted(by_step, key=float)])
        for row in self.rows("raw/points"):
            if row["status"] == "ok":
                self.assertGreaterEqual(float(row["sample_s"]), 0.00499)
        cheapest = self.rows("tables/points_cheapest")
        self.assertEqual([row["status"] for row in cheapest], ["ok", "none"])
        self.assertEqual([row["status"] for row in self.rows("tables/points_comparisons")], ["ok"])
        self.assertIn("times cheaper", result.stdout)

    def test_adaptive_steps_and_implicit_methods_have_points(self):
        times = {"end_time": 1e-4, "saved_times": 4}
        alone = {**BLOCK, "variants": ["reference"], "precisions": ["f64"]}
        self.study(
            cells=[
                {**alone, "integrators": ["dopri5"], "accuracy": {**times, "rtol": [1e-3, 1e-6]}},
                {
                    **alone,
                    "integrators": ["implicit_midpoint"],
                    "accuracy": {**times, "halvings": [0, 3]},
                },
            ]
        )
        result = self.experiment()
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        table = self.rows("tables/points")
        self.assertEqual([(row["integrator"], row["rtol"], row["status"]) for row in table],
                         [("dopri5", "0.001", "ok"), ("dopri5", "1e-06", "ok"),
                          ("implicit_midpoint", "", "ok"), ("implicit_midpoint", "", "ok")])
        coarse, fine, *implicit = table
        self.assertGreater(int(fine["steps"]), int(coarse["steps"]))
        for row in (coarse, fine):
            self.assertGreaterEqual(float(row["evaluations"]), 7 * 36 * int(row["steps"]))
        self.assertLess(float(fine["error_max"]), 0.1 * float(coarse["error_max"]))
        self.assertEqual([row["evaluations"] for row in implicit], ["", ""])
        self.assertLess(float(implicit[1]["error_max"]), 0.1 * float(implicit[0]["error_max"]))
        self.assertIn("rtol 0.001", result.stdout)

    def test_the_reference_says_how_long_a_run_is(self):
        self.study(cells=[{
            **BLOCK, "variants": ["reference"], "precisions": ["f64"],
            "accuracy": {"end_time": 1e-4, "saved_times": 4, "dt": [1e-6]}
        }])
        self.assertEqual(self.experiment().returncode, 0)
        (solution,) = os.listdir(self.path("out/oracle"))
        plate = ("run", "plate_paper", "--set", "n=6", "--reference",
                 self.path(f"out/oracle/{solution}"))
        record = json.loads(dssbench(*plate, "--dt", "5e-7", "--json", "-").stdout)
        self.assertEqual((record["steps"], record["saved_times"], record["status"]), (200, 4, "ok"))
        self.assertGreater(record["error_max"], record["error_l2"])
        self.assertIsNone(record["energy_drift"])
        self.assert_refused(2, ["--reference", "3e-06", "2.5e-05"], *plate, "--dt", "3e-6")
        self.assert_refused(2, ["--reference", "--steps 100"], *plate, "--dt", "1e-6", "--steps",
                            "50")
        self.assert_refused(2, ["--reference", "36", "49"], *plate, "--set", "n=7")
        self.assert_refused(2, ["is no solution"], "run", "plate_paper", "--reference",
                            self.path("points.json"))

    def test_a_known_stability_limit_is_not_predicted_again(self):
        plate = ("run", "plate_paper", "--set", "n=6", "--dt", "2e-6", "--steps", "5")
        self.assertEqual(
            json.loads(dssbench(*plate, "--stability-limit", "2.5e-6", "--json",
                                "-").stdout)["stability_limit_s"], 2.5e-6)
        self.assert_refused(3, ["2e-06", "1e-06", "--stability-limit"], *plate, "--stability-limit",
                            "1e-6")
        self.assert_refused(2, ["--stability-limit 0"], *plate, "--stability-limit", "0")

    def test_energy_of_an_undamped_scene_drifts_by_what_the_method_loses(self):
        box = ("run", "tumbling_box", "--set", "bodies/0/constants/damping_ratio=0", "--steps",
               "100", "--json", "-")
        drift = {
            dt: json.loads(dssbench(*box, "--dt", dt).stdout)["energy_drift"]
            for dt in ("2e-4", "4e-4")
        }
        self.assertLess(abs(drift["2e-4"]), 1e-6)
        self.assertGreater(abs(drift["4e-4"]), 8 * abs(drift["2e-4"]))

    def test_wrong_studies_are_refused_with_their_place(self):
        for changes, words in (
            (
                {"cells": [{**BLOCK, "accuracy": {**BLOCK["accuracy"], "dt": [1.1e-6]}}]},
                ["/cells/0/accuracy/dt/0", "1.1e-06"],
            ),
            (
                {"cells": [{**BLOCK, "accuracy": {"end_time": 1e-4, "saved_times": 4}}]},
                ["/cells/0/accuracy", "halvings"],
            ),
            (
                {"cells": [{**BLOCK, "accuracy": {**BLOCK["accuracy"], "rtol": [1e-4]}}]},
                ["/cells/0/accuracy/rtol", "rk4", "dopri5"],
            ),
            (
                {"cells": [{**BLOCK, "accuracy": {"end_time": -1, "saved_times": 4}}]},
                ["/cells/0/accuracy/end_time", "-1"],
            ),
            ({"work_precision": {**RULES, "tolerances": [0]}}, ["/work_precision/tolerances", "0"]),
            (
                {"work_precision": {**RULES, "solution": {"integrator": "rk5"}}},
                ["/work_precision/solution/integrator", "rk4"],
            ),
        ):
            self.study(**changes)
            self.assert_refused(2, words, "experiment", self.path("points.json"), "--scale",
                                "smoke", "--out", self.path("out"))
        scene = BUDGET["error_budget"]["scenes"][0]
        for change, words in (
            ({"dt": 3e-6}, ["/error_budget/scenes/0", "3e-06"]),
            ({"refinement": {"grids": [{"n": 4}, {"n": 8}],
                             "keeps": "x"}}, ["/error_budget/scenes/0/refinement/grids", "three"]),
            ({"scene": "plate_papr"}, ["/error_budget/scenes/0", "plate_paper"]),
        ):
            self.write("b.json",
                       json.dumps({**BUDGET, "error_budget": {"scenes": [{**scene, **change}]}}))
            self.assert_refused(2, words, "experiment", self.path("b.json"), "--scale", "smoke",
                                "--out", self.path("out"))


if __name__ == "__main__":
    unittest.main()
