"""Step limits: what the study predicts, measures and refuses."""
import csv
import json
import os
import unittest

from program import ProgramTest, dssbench

SCENES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../experiments/scenes")


class StepLimits(ProgramTest):
    def test_a_study_of_step_limits_writes_what_it_predicts_and_measures(self):
        result = dssbench("experiment", "stability", "--scale", "smoke", "--out", self.path("out"))
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        tables = {}
        for name in ("stability", "stability_energy", "stability_map"):
            with open(self.path(f"out/tables/{name}.csv"), encoding="utf-8") as file:
                tables[name] = list(csv.DictReader(file))
        methods = {row["integrator"] for row in tables["stability"]}
        for scene in ("one_mode", "two_elements", "chain", "cantilever_beam"):
            self.assertEqual(
                {row["integrator"] for row in tables["stability"] if row["scene"] == scene}, methods
            )
        for row in tables["stability"]:
            self.assertEqual(row["status"], "ok", row)
            self.assertAlmostEqual(float(row["ratio"]), 1, delta=0.01)
        self.assertEqual({row["status"] for row in tables["stability_energy"]}, {"ok"})
        self.assertEqual({row["integrator"] for row in tables["stability_map"]}, methods)
        most = [
            row for row in tables["stability_energy"]
            if row["integrator"] == "rk4" and abs(float(row["h_omega"])**2 - 6) < 1e-9
        ]
        self.assertAlmostEqual(float(most[0]["measured_energy_change_per_step"]), -0.75, delta=1e-9)

    def test_a_study_of_step_limits_that_is_wrong_says_where_and_keeps_earlier_tables(self):
        os.makedirs(self.path("out/tables"))
        self.write("out/tables/limits.csv", "earlier")
        mode = {"scene": os.path.join(SCENES, "stability/one_mode.json"), "zeta": [0]}
        good = {"experiment": "limits", "title": "t", "stability": {"mode": mode, "scenes": []},
                "scales": {"smoke": {"energy_points": 3, "map_points": 3}}}
        for change, words in (
            ({"mode": {**mode, "zeta": [-1]}}, ["/stability/mode/zeta/0", "at least 0"]),
            ({"mode": {**mode, "scene": "two_elements"}}, ["/stability/mode/scene", "omega"]),
            ({"variant": "avx3"}, ["/stability/variant", "avx2"]),
            ({"scenes": [{"scene": "chian"}]}, ["chian", "chain"]),
            ({"modes": mode}, ["modes", "mode"]),
        ):
            study = self.write("limits.json",
                               json.dumps({**good, "stability": {**good["stability"], **change}}))
            self.assert_refused(2, words, "experiment", study, "--scale", "smoke", "--out",
                                self.path("out"))
        self.assert_refused(2, ["--scale", "smoke"], "experiment",
                            self.write("limits.json", json.dumps(good)), "--scale", "smok", "--out",
                            self.path("out"))
        self.assertEqual(self.read("out/tables/limits.csv"), "earlier")


if __name__ == "__main__":
    unittest.main()
