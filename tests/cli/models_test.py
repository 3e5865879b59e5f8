"""`--model auto`, its records, and `explain`."""
import csv
import json
import pathlib
import unittest

from program import ProgramTest, dssbench

ROOT = pathlib.Path(__file__).resolve().parents[2]
LADDER = ROOT / "experiments" / "scenes" / "ladder"


class Models(ProgramTest):
    def run_json(self, scene, *arguments):
        result = dssbench("run", scene, *arguments, "--json", "-")
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def test_auto_is_the_default_and_the_record_says_what_it_chose_and_why(self):
        record = self.run_json("plate_paper", "--set", "n=10", "--steps", "20")
        choice = record["model_choice"]
        self.assertEqual((record["model"], choice["asked"], choice["chosen"]),
                         ("planar", "auto", "planar"))
        self.assertIn("proven", choice["why"])
        self.assertEqual(sorted(choice["smaller"]), ["axial", "bending", "membrane"])
        self.assertIn("load 0 has force x", choice["smaller"]["bending"])
        self.assertEqual((choice["is_bounded"], choice["monitor"], choice["promotions"]),
                         (False, None, []))

    def test_a_named_model_is_taken_as_it_is(self):
        record = self.run_json("plate_paper", "--set", "n=10", "--steps", "20", "--model",
                               "spatial")
        self.assertEqual((record["model"], record["model_choice"]["asked"]), ("spatial", "spatial"))
        scene = json.loads(
            dssbench("run", "plate_paper", "--set", "n=10", "--set", "run.model=linear", "--steps",
                     "20", "--json", "-").stdout)
        self.assertEqual(scene["model"], "linear")

    def test_a_run_over_the_bound_is_promoted_and_the_record_says_where(self):
        record = self.run_json(LADDER / "roll_up.json", "--set", "n=8")
        choice = record["model_choice"]
        self.assertEqual((choice["chosen"], record["model"], record["status"]),
                         ("bending", "spatial", "ok"))
        self.assertEqual(choice["promotions"][-1]["to"], "spatial")
        self.assertGreater(choice["promotions"][0]["step"], 1000)
        self.assertGreater(choice["promotions"][0]["estimate"], choice["monitor"]["limit"])
        self.assertLessEqual(choice["monitor"]["estimate"], choice["monitor"]["limit"])
        self.assertGreater(choice["monitor"]["largest_rotation_rad"], 0)
        summary = dssbench("run", LADDER / "roll_up.json", "--set", "n=8").stdout
        self.assertIn("promoted from bending to spatial: after step", summary)

    def test_a_run_over_the_bound_can_stop_instead_with_one_line_and_no_files(self):
        state = self.path("state.csv")
        self.assert_refused(1, ["error of model bending", "tolerance 0.001", "--model spatial"],
                            "run", LADDER / "roll_up.json", "--set", "n=8", "--on-bound", "stop",
                            "--state", state)
        self.assertFalse(pathlib.Path(state).exists())
        record = json.loads(
            dssbench("run", LADDER / "roll_up.json", "--set", "n=8", "--on-bound", "stop", "--json",
                     "-").stdout)
        self.assertEqual((record["status"], record["state_digest"]), ("bound", None))

    def test_the_tolerance_of_the_model_decides_between_proof_and_bound(self):
        coarse = self.run_json("cantilever_beam", "--set", "n=8", "--steps", "50",
                               "--model-tolerance", "1e-2")
        fine = self.run_json("cantilever_beam", "--set", "n=8", "--steps", "50")
        self.assertEqual((coarse["model"], fine["model"]), ("bending", "spatial"))
        self.assertIn("only proof helps", fine["model_choice"]["smaller"]["bending"])

    def test_what_is_wrong_is_told_in_one_line(self):
        run = ("run", "plate_paper", "--set", "n=10", "--steps", "5")
        self.assert_refused(2, ["--model-tolerance", "positive"], *run, "--model-tolerance", "-1")
        self.assert_refused(2, ["--on-bound", "promote"], *run, "--on-bound", "promot")
        self.assert_refused(2, ["--model bending", "load 0 has force x"], *run, "--model",
                            "bending")
        self.assert_refused(2, ["--model axial", "need not move alike"], *run, "--model", "axial")
        self.assert_refused(2, ["/run/model", "extra link"], "run", LADDER / "eccentric.json",
                            "--set", "run.model=bending")
        self.assert_refused(2, ["nosuch"], "explain", "nosuch")
        self.assert_refused(2, ["--precision f46", "f64"], "explain", "chain", "--precision", "f46")

    def test_explain_says_what_is_needed_and_why_the_rest_is_not(self):
        result = dssbench("explain", "plate_paper", "--set", "n=10")
        self.assertEqual(result.returncode, 0, result.stderr)
        for words in ("model planar: proven", "not axial: rows", "uz",
                      "symmetric about the plane z = const", "kt is zero",
                      "inertia is a scalar", "rotations"):
            self.assertIn(words, result.stdout)
        explained = json.loads(
            dssbench("explain", "plate_paper", "--set", "n=10", "--json", "-").stdout)
        needed = [
            name for name, need in explained["degrees_of_freedom"].items() if need["is_needed"]
        ]
        self.assertEqual((explained["model"], explained["is_proven"], needed),
                         ("planar", True, ["ux", "uy", "rz"]))
        self.assertTrue(
            all(need["why"]
                for part in ("degrees_of_freedom", "terms", "rotations")
                for need in explained[part].values()))

    def test_explain_shows_the_constants_of_links_and_what_is_too_soft(self):
        bar = ("explain", ROOT / "experiments" / "scenes" / "continuum" / "solid_bar.json",
               "--set", "n=3", "--set", "E=1e7", "--set", "G=4e6", "--set", "side=0.3")
        shown = dssbench(*bar)
        self.assertIn("k_shear_x", shown.stdout)
        self.assertNotIn("note:", shown.stdout)
        solid = json.loads(dssbench(*bar, "--json", "-").stdout)
        self.assertEqual(solid["notes"], [])
        # Edges of 0.1 m: E A / L, and 2 G A / L across.
        along_x = solid["links_by_kind"][0]
        self.assertEqual((along_x["body"], along_x["axis"], along_x["count"]), ("bar", "x", 207))
        self.assertAlmostEqual(along_x["k_normal_n_per_m"], 1e6)
        for shear, expected in zip(along_x["k_shear_n_per_m"], (0, 8e5, 8e5)):
            self.assertAlmostEqual(shear, expected)
        beams = dssbench(*bar, "--set", "bodies/0/constants/law=material")
        self.assertIn("note: body \"bar\"", beams.stdout)
        self.assertIn("the law \"solid\" has all of G", beams.stdout)

    def test_explain_knows_that_nothing_turns_in_free_flight(self):
        flight = ("explain", ROOT / "experiments" / "scenes" / "failures" / "free_flight.json")
        for model, degrees, *change in (
            (
                "membrane",
                ["ux", "uy"], "--set", "az=0", "--set", "vz=0", "--set", "gravity.1=-9.81",
            ),
            ("bending", ["uz"], "--set", "ax=0", "--set", "vx=0"),
        ):
            explained = json.loads(dssbench(*flight, *change, "--json", "-").stdout)
            needed = [
                name for name, need in explained["degrees_of_freedom"].items() if need["is_needed"]
            ]
            self.assertEqual((explained["model"], explained["is_proven"], needed),
                             (model, True, degrees))
            self.assertFalse(explained["terms"]["damping of links"]["is_needed"])

    def test_explain_agrees_with_what_run_chooses(self):
        for scene in ("chain", "block", "two_bodies", "tumbling_box", LADDER / "strip.json",
                      LADDER / "eccentric.json"):
            explained = json.loads(dssbench("explain", scene, "--json", "-").stdout)
            self.assertEqual(explained["model"],
                             self.run_json(scene, "--steps", "2")["model_choice"]["chosen"])

    def test_explain_knows_that_implicit_methods_cannot_be_watched(self):
        implicit = ("--set", "run.integrator=implicit_midpoint", "--json", "-")
        explained = json.loads(dssbench("explain", LADDER / "strip.json", *implicit).stdout)
        self.assertEqual((explained["model"], explained["is_proven"]), ("spatial", True))
        self.assertIn("implicit", explained["smaller"]["bending"])

    def ladder(self, name, *scenes):
        study = {
            "experiment": name, "title": "t", "model_ladder": {"scenes": list(scenes)},
            "scales": {"host": {}}
        }
        result = dssbench("experiment", self.write(f"{name}.json", json.dumps(study)), "--scale",
                          "host", "--out", self.directory)
        with open(self.path(f"tables/{name}.csv"), encoding="utf-8") as file:
            return result.returncode, list(csv.DictReader(file))

    def test_the_ladder_holds_every_model_against_the_oracle(self):
        strip = {"scene": str(LADDER / "strip.json"), "set": {"n": 5, "width": 2}, "steps": 300}
        exit_code, rows = self.ladder("ladder",
                                      dict(strip, auto="bending", fails=["axial", "planar"]))
        self.assertEqual((exit_code, [row["status"] for row in rows]), (0, ["ok"] * 8))
        verdicts = {row["model"]: (row["verdict"], row["provable"]) for row in rows}
        self.assertEqual(verdicts["planar"], ("insufficient", "no"))
        self.assertEqual(verdicts["bending"], ("sufficient", "bounded"))
        self.assertEqual(verdicts["spatial"], ("sufficient", "proven"))
        self.assertEqual((rows[-1]["ends_with"], rows[-1].get("sufficient_smaller", "")),
                         ("bending", ""))

    def test_the_ladder_fails_in_both_directions(self):
        strip = {"scene": str(LADDER / "strip.json"), "set": {"n": 4, "width": 1}, "steps": 50}
        exit_code, rows = self.ladder("stronger", dict(strip, auto="bending", fails=["linear"]))
        self.assertEqual((exit_code, [row["model"] for row in rows if row["status"] == "failed"]),
                         (1, ["linear"]))
        exit_code, rows = self.ladder("worse", dict(strip, auto="bending", suffices=["axial"]))
        self.assertEqual((exit_code, [row["model"] for row in rows if row["status"] == "failed"]),
                         (1, ["axial"]))
        exit_code, rows = self.ladder("weaker", dict(strip, auto="spatial"))
        self.assertEqual((exit_code, rows[-1]["status"]), (1, "failed"))
        self.assertIn("auto ends with bending, expected spatial", rows[-1]["reason"])

    def test_every_term_is_named_where_a_scene_has_it(self):
        terms = json.loads(dssbench("explain", "two_bodies", "--json", "-").stdout)["terms"]
        self.assertEqual([name for name, need in terms.items() if not need["is_needed"]],
                         ["pressure of elements", "loads", "initial motions"])
        self.assertIn("k 20 N/m", terms["stabilization"]["why"])


if __name__ == "__main__":
    unittest.main()
