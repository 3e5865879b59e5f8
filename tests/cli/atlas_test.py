"""The failure atlas and the continuum checks: a wrong expectation fails in both directions."""
import csv
import json
import os
import unittest

from program import ProgramTest, dssbench

EXPERIMENTS = os.path.join(os.path.dirname(__file__), "..", "..", "experiments", "scenes")


def case(**changes):
    """An undamped pair, 10 % below and 10 % above the limit of its mode."""
    return {
        "case": "pair",
        "scene": os.path.join(EXPERIMENTS, "failures", "pair.json"),
        "methods": ["rk4"],
        "mode": {"omega": "=sqrt(k/mass)", "rate": 0},
        "dt": "=0.9*mode_limit",
        "steps": 400,
        "forced": True,
        "metric": "amplitude",
        "ok": {"below": 1.1},
        "unstable_above": 100,
        "expect": [{"verdict": "ok", "why": "below the limit"}],
        **changes,
    }


class Atlas(ProgramTest):
    def study(self, *cases, name="atlas"):
        text = {"experiment": name, "title": "t", "failures": list(cases), "scales": {"host": {}}}
        return self.write("atlas.json", json.dumps(text))

    def rows(self, name="atlas"):
        with open(self.path(f"tables/{name}.csv"), encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def run_study(self, *cases):
        return dssbench("experiment", self.study(*cases), "--out", self.directory)

    def test_the_shipped_atlas_says_what_theory_says(self):
        result = dssbench("experiment", "failures", "--scale", "smoke", "--out", self.directory)
        self.assertEqual(result.returncode, 0, result.stdout)
        rows = self.rows("failures")
        self.assertEqual({row["status"] for row in rows}, {"passed"})
        self.assertEqual({row["verdict"]
                          for row in rows} - {"drifts"},
                         {"ok", "inaccurate", "unstable", "refused"})

    def test_the_shipped_continuum_checks_pass(self):
        result = dssbench("experiment", "continuum", "--scale", "smoke", "--out", self.directory)
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assertEqual({row["status"] for row in self.rows("continuum")}, {"passed", "coarse"})

    def test_a_method_that_should_fail_and_does_not_is_a_failed_check(self):
        wrong = [{"verdict": "unstable", "why": "a wrong theory"}]
        result = self.run_study(case(expect=wrong))
        self.assertEqual(result.returncode, 1)
        self.assertIn("expected unstable", result.stdout)
        self.assertEqual((self.rows()[0]["verdict"], self.rows()[0]["status"]), ("ok", "failed"))

    def test_a_method_that_fails_where_it_should_not_is_a_failed_check(self):
        result = self.run_study(case(dt="=1.1*mode_limit"))
        self.assertEqual(result.returncode, 1)
        self.assertEqual((self.rows()[0]["verdict"], self.rows()[0]["status"]),
                         ("unstable", "failed"))

    def test_a_run_that_stops_being_finite_is_named_with_step_time_and_element(self):
        self.run_study(case(dt="=1.1*mode_limit", steps=100000))
        self.assertRegex(self.rows()[0]["reason"],
                         r"not finite after step \d+ \(t = [0-9.e+-]+ s\), element 1")

    def test_a_figure_far_from_its_prediction_is_a_failed_check(self):
        expect = [{"verdict": "ok", "why": "x", "predicted": 0.5, "within": 0.1}]
        result = self.run_study(case(expect=expect, steps=1, dt="=1e-9*mode_limit"))
        self.assertEqual(result.returncode, 1)
        self.assertIn("from the prediction", result.stdout)

    def test_a_step_above_the_limit_is_refused_unless_forced(self):
        refused = [{"verdict": "refused", "why": "above the limit"}]
        result = self.run_study(case(dt="=1.1*mode_limit", forced=False, expect=refused))
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assertIn("stability limit", self.rows()[0]["reason"])

    def test_a_cell_without_expectation_is_a_failed_check(self):
        result = self.run_study(
            case(expect=[{"methods": ["velocity_verlet"], "verdict": "ok", "why": "x"}]))
        self.assertEqual(result.returncode, 1)
        self.assertIn("no expectation", result.stdout)

    def test_a_reference_that_cannot_be_had_fails_its_cell_and_the_others_go_on(self):
        reference = {"closed_form": "step_load", "element": 2, "omega": 1, "static": 1, "onset": 0}
        result = self.run_study(case(case="wrong", metric="error", reference=reference), case())
        self.assertEqual(result.returncode, 1)
        self.assertIn("element 2 is not one of the 2", self.rows()[0]["reason"])
        self.assertEqual([row["status"] for row in self.rows()], ["failed", "passed"])

    def test_errors_name_the_place_and_leave_earlier_results(self):
        self.run_study(case())
        before = self.read("tables/atlas.csv")
        for wrong, words in (
            ({"methods": ["rk5"]}, ["/failures/0/methods", "rk4"]),
            ({"metric": "eror"}, ["/failures/0/metric", '"error"']),
            ({"metric": "error"}, ["/failures/0", "reference"]),
            ({"expect": [{"verdict": "fine",
                          "why": "x"}]}, ["/failures/0/expect/0/verdict", "fine"]),
            ({"dt": "=0.9*limitt"}, ["/failures/0/dt", "limitt"]),
            ({"set": {"kk": 1}}, ["kk"]),
            ({"case": "pair", "dtt": 1}, ["/failures/0", "dtt"]),
        ):
            self.assert_refused(2, words, "experiment", self.study(case(**wrong)), "--out",
                                self.directory)
        self.assertEqual(self.read("tables/atlas.csv"), before)

    def test_a_dry_run_computes_nothing(self):
        result = dssbench("experiment", self.study(case()), "--out", self.directory, "--dry-run")
        self.assertEqual(result.returncode, 0)
        self.assertFalse(os.path.exists(self.path("tables")))


if __name__ == "__main__":
    unittest.main()
