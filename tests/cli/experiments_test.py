"""`experiment`: records, resuming, and failures that stay in their cell."""
import json
import os
import pathlib
import resource
import subprocess
import sys
import time
import unittest

from program import PROGRAM, dssbench
from tiny_study import SIX, STUDY, TinyStudyTest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "plots"))
from tables import sources  # noqa: E402

SCENES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../experiments/scenes")


class Experiments(TinyStudyTest):
    def test_every_repetition_is_checked_and_recorded(self):
        self.study(scales={"smoke": SIX})
        result = self.experiment()
        self.assertEqual(result.returncode, 0, result.stderr + result.stdout)
        raw = self.rows("raw")
        self.assertEqual(len(raw), 3 * 6)
        for row in raw:
            self.assertEqual((row["check"], row["status"]), ("passed", "ok"))
            self.assertGreater(float(row["check_error"]), 0)
            self.assertGreater(float(row["check_tail_error"]), 0)
            self.assertGreater(float(row["wall_s"]), 0)
        table = self.rows("tables")
        self.assertEqual([row["source"] for row in table], ["measured"] * 3 + ["paper"])
        self.assertGreater(float(table[1]["speedup_vs_reference"]), 0)
        self.assertEqual((table[3]["paper_wall_s"], table[3]["measured_wall_s"]), ("12.5", ""))
        self.assertTrue(json.loads(self.read("out/raw/tiny.json"))["context"]["denormals_flushed"])
        self.assertIn(self.path("out/tables/tiny.csv"), result.stdout)

    def test_records_name_the_sources_as_the_report_computes_them(self):
        self.study()
        self.experiment()
        named = json.loads(self.read("out/raw/tiny.json"))["sources"]
        self.assertEqual(named["core"], sources.digest(*sources.CORE))
        self.assertEqual(named["json"], sources.fnv1a(pathlib.Path(self.path("tiny.json"))))

    def test_resume_measures_only_what_is_missing(self):
        self.study()
        self.experiment()
        lines = self.read("out/raw/tiny.csv").splitlines(keepends=True)
        kept = lines[:4]
        self.write("out/raw/tiny.csv", "".join(kept) + lines[4][:30])
        self.assertEqual(self.experiment("--resume").returncode, 0)
        resumed = self.read("out/raw/tiny.csv").splitlines(keepends=True)
        self.assertEqual(resumed[:4], kept)
        self.assertEqual(len(resumed), 1 + 3 * 2)
        self.assertEqual(self.experiment("--resume").returncode, 0)
        self.assertEqual(self.read("out/raw/tiny.csv").splitlines(keepends=True), resumed)

    def test_rounds_can_be_spread_over_calls(self):
        self.study()
        for rounds, records in (("1", 3), ("5", 3 * 2)):
            resume = () if rounds == "1" else ("--resume",)
            self.assertEqual(self.experiment("--rounds", rounds, *resume).returncode, 0)
            self.assertEqual(len(self.rows("raw")), records)
        self.assert_refused(2, ["--rounds", "not measured in rounds"], "experiment", "failures",
                            "--scale", "smoke", "--rounds", "1", "--out", self.path("out"))

    def scene_study(self, force):
        with open(os.path.join(SCENES, "two_elements.json"), encoding="utf-8") as file:
            scene = json.load(file)
        scene["gravity"] = force
        self.write("pair.json", json.dumps(scene))
        self.study(cells=[{"scene": self.path("pair.json"), "variants": ["reference", "scalar"]}])

    def test_resume_refuses_records_of_another_scene_or_program(self):
        self.scene_study([1000, 0, 0])
        self.assertEqual(self.experiment().returncode, 0)
        self.scene_study([2000, 0, 0])
        self.assert_refused(2, ["pair.json", "has changed"], "experiment", self.path("tiny.json"),
                            "--scale", "smoke", "--resume", "--out", self.path("out"))
        circumstances = json.loads(self.read("out/raw/tiny.json"))
        circumstances["context"]["git_commit"] = "another"
        self.write("out/raw/tiny.json", json.dumps(circumstances))
        self.assert_refused(2, ["git_commit", "another"], "experiment", self.path("tiny.json"),
                            "--scale", "smoke", "--resume", "--out", self.path("out"))

    def test_resume_tries_failed_cells_again(self):
        scale = {**STUDY["scales"]["smoke"], "steps": 30000, "time_limit_s": 0.1}
        self.study(scales={"smoke": scale})
        self.assertEqual(self.experiment().returncode, 1)
        self.study(scales={"smoke": {**scale, "time_limit_s": 60, "repetitions": [1, 1]}})
        result = self.experiment("--resume")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_earlier_records_outlive_a_full_disk_and_a_trial_at_another_scale(self):
        self.study(scales={name: STUDY["scales"]["smoke"] for name in ("smoke", "trial")})
        self.experiment()
        before = self.read("out/raw/tiny.csv")
        self.assert_refused(2, ['"smoke"', '"trial"', "--out"], "experiment",
                            self.path("tiny.json"), "--scale", "trial", "--out", self.path("out"))
        self.assertEqual(self.read("out/raw/tiny.csv"), before)
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (512, 512))  # noqa: E731
        result = dssbench("experiment", self.path("tiny.json"), "--scale", "smoke", "--out",
                          self.path("out"), preexec_fn=limit)
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        kept = self.path("out/raw/tiny.csv.previous") if os.path.exists(
            self.path("out/raw/tiny.csv.previous")) else self.path("out/raw/tiny.csv")
        self.assertEqual(self.read(kept), before)

    def test_a_killed_experiment_takes_its_measuring_process_along(self):
        scale = {**STUDY["scales"]["smoke"], "steps": 100000000, "oracle_steps": 1}
        self.study(cells=[{**STUDY["cells"][0], "variants": ["scalar"]}],
                   base=["scalar"],
                   scales={"smoke": scale})
        mark = self.path("tiny.json")
        run = subprocess.Popen(
            [PROGRAM, "experiment", mark, "--scale", "smoke", "--out",
             self.path("out")],
            stdout=subprocess.DEVNULL)
        children = f"/proc/{run.pid}/task/{run.pid}/children"
        for _ in range(200):
            time.sleep(0.05)
            with open(children, encoding="utf-8") as file:
                if child := file.read().split():
                    break
        run.kill()
        run.wait()
        self.assertTrue(child)
        for _ in range(100):
            time.sleep(0.05)
            if not os.path.exists(f"/proc/{child[0]}"):
                return
        self.fail("the measuring process lives on")

    def test_a_changed_file_of_voxels_gets_a_new_oracle(self):
        with open(os.path.join(SCENES, "l_bracket.json"), encoding="utf-8") as file:
            scene = json.load(file)
        scene["bodies"][0]["geometry"] = {"voxels": {"file": "mask.txt"}}
        self.write("bracket.json", json.dumps(scene))
        cells = [{"scene": self.path("bracket.json"), "variants": ["reference", "scalar"]}]
        self.study(cells=cells)
        for hole in ("#############.#", "####.##########"):
            self.write("mask.txt", "\n".join(["#" * 15, hole] + ["#" * 15] * 3) + "\n")
            result = self.experiment("--resume")
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
            os.remove(self.path("out/raw/tiny.csv"))
        self.assertEqual(len(os.listdir(self.path("out/oracle"))), 2)

    def test_a_cell_past_its_time_limit_is_recorded_and_the_rest_goes_on(self):
        scale = {
            **STUDY["scales"]["smoke"], "steps": 300000, "steps_for": {"scalar": 40},
            "time_limit_s": 1
        }
        self.study(scales={"smoke": scale})
        self.assertEqual(self.experiment().returncode, 1)
        table = {row["label"]: row for row in self.rows("tables")}
        self.assertEqual(table["reference, 1 thread"]["status"], "time limit")
        self.assertEqual(table["reference, 1 thread"]["reason"], "time limit of 1 s")
        self.assertEqual(table["scalar, 1 thread"]["status"], "ok")
        # No row has this column, so the table leaves it out.
        self.assertNotIn("speedup_vs_reference", table["scalar, 1 thread"])
        self.assertGreater(float(table["scalar, 1 thread"]["extrapolated_wall_s"]), 0)

    def test_a_cell_that_the_program_refuses_is_recorded_with_its_reason(self):
        self.study(cells=[{
            "scene": "plate_paper", "set": {"n": 10, "run.dt": [1e-6, 1e-5]},
            "variants": ["reference", "scalar"]
        }])
        self.assertEqual(self.experiment().returncode, 1)
        statuses = {(row["set"], row["status"])
                    for row in self.rows("tables")
                    if row["source"] == "measured"}
        self.assertEqual({status
                          for set_text, status in statuses
                          if "1e-05" not in set_text}, {"ok"})
        refused = [row for row in self.rows("tables") if "1e-05" in row["set"]]
        self.assertEqual({row["status"] for row in refused}, {"failed"})
        self.assertIn("stability limit", refused[0]["reason"])
        self.assertEqual({row.get("speedup_vs_reference", "") for row in refused}, {""})

    def test_a_wrong_state_keeps_its_time_and_fails(self):
        self.study()
        self.experiment()
        states = [name for name in os.listdir(self.path("out/oracle")) if name.endswith(".state")]
        self.assertEqual(len(states), 1)
        with open(self.path("out/oracle/" + states[0]), "r+b") as file:
            file.seek(-8 * 13 * 3, os.SEEK_END)
            file.write(b"\x00" * 8)
        arguments = ("run", "plate_paper", "--set", "n=10", "--steps", "40", "--check-state",
                     self.path("out/oracle/" + states[0]))
        result = dssbench(*arguments, "--json", "-")
        record = json.loads(result.stdout)
        self.assertEqual((result.returncode, record["status"], record["check"]),
                         (1, "wrong", "failed"))
        self.assertGreater(record["wall_s"], 0)

    def test_bad_studies_are_refused_with_their_place_and_leave_earlier_results(self):
        self.study()
        self.experiment()
        before = self.read("out/raw/tiny.csv")
        for changes, words in (
            ({"titel": "x"}, ["tiny.json", "titel"]),
            ({"base": ["scala"]}, ["/base", '"scalar"']),
            ({"base": ["avx2"]}, ["/base", "no cell", '"avx2"']),
            ({"twin": "avx2"}, ["/twin", "no cell", '"avx2"']),
            ({
                "cells": [{"scene": "plate_paper", "set": {"n": [10, 10]}, "variants": ["scalar"]}],
                "base": ["scalar"]
            }, ["/cells", "twice"]),
            ({"scales": {"smoke": {"steps": -1}}}, ["/scales/smoke/steps", "-1"]),
            ({"cells": [{"scene": "plate_paper", "variants": ["scalar"],
                         "models": ["flat"]}]}, ["/cells/0/models", "flat"]),
            ({"cells": [{"scene": "plate_papr",
                         "variants": ["scalar"]}]}, ["/cells/0", '"plate_paper"']),
            ({"cells": [{"scene": "plate_paper", "set": {"m": 10},
                         "variants": ["scalar"]}]}, ["/cells/0", "m"]),
            ({"cells": [{"scene": "plate_paper", "set": {"n": -3},
                         "variants": ["scalar"]}]}, ["/cells/0", "/geometry/box"]),
            ({"cells": [{"scene": "plate_bending", "variants": ["scalar"],
                         "models": ["planar"]}]}, ["/cells/0", "planar"]),
            ({"cells": [{"scene": "plate_paper",
                         "variants": ["scaler"]}]}, ["/cells/0/variants", '"scalar"']),
            ({"scales": {"smoke": {"steps": 40, "steps_by_set": {"n=11": 9}}}}, [
                "/scales/smoke/steps_by_set", "n=11", "n=10"
            ]),
        ):
            self.study(**changes)
            self.assert_refused(2, words, "experiment", self.path("tiny.json"), "--scale", "smoke",
                                "--out", self.path("out"))
            self.assert_refused(2, words, "experiment", self.path("tiny.json"), "--scale", "smoke",
                                "--dry-run")
        self.assertEqual(self.read("out/raw/tiny.csv"), before)

    def test_a_dry_run_lists_the_cells_and_writes_nothing(self):
        self.study()
        result = self.experiment("--dry-run")
        self.assertEqual(result.returncode, 0)
        self.assertIn("3 cells", result.stdout)
        self.assertFalse(os.path.exists(self.path("out")))

    def test_steps_by_set_give_each_size_its_own_number(self):
        cells = [{
            "scene": "plate_paper", "set": {"n": [10, 12]}, "variants": ["reference", "scalar"]
        }]
        scale = {
            **STUDY["scales"]["smoke"], "steps_by_set": {"n=12": 30},
            "steps_for": {"reference": 35}
        }
        self.study(cells=cells, scales={"smoke": scale})
        self.assertEqual(self.experiment().returncode, 0)
        steps = {(row["set"], row["variant"], row["steps"])
                 for row in self.rows("tables")
                 if row["source"] == "measured"}
        self.assertEqual(
            steps,
            {
                ("n=10", "reference", "35"),
                ("n=10", "scalar", "40"),
                ("n=12", "reference", "30"),
                ("n=12", "scalar", "30"),
            },
        )


if __name__ == "__main__":
    unittest.main()
