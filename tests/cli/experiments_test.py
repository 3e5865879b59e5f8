"""`experiment` and `compare`: records, resumption, failures that stay in their cell."""
import csv
import json
import os
import resource
import shutil
import subprocess
import sys
import time
import unittest

from program import PROGRAM, ProgramTest, dssbench

PLOTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../plots")
SCENES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../experiments/scenes")
STUDY = {
    "experiment": "tiny",
    "title": "A tiny study",
    "cells": [{"scene": "plate_paper", "set": {"n": [10]}, "variants": ["reference", "scalar"], "threads": [1]}],
    "base": ["reference"],
    "twin": "scalar",
    "paper": {"source": "nobody", "rows": [{"label": "published", "wall_s": 12.5}]},
    "scales": {"smoke": {"steps": 40, "oracle_steps": 20, "repetitions": [2, 2], "retries": 0, "budget_s": 60, "time_limit_s": 20}},
}


def why_no_ranks():
    """Why cells on several ranks cannot be measured here, or an empty string."""
    mpi = [variant for variant in json.loads(dssbench("list", "variants", "--json").stdout) if variant["variant"] == "mpi"]
    if not mpi:
        return "built without the variant mpi"
    return ("" if mpi[0]["status"] == "usable" else mpi[0]["status"]) or ("" if shutil.which("mpirun") else "mpirun is not installed")


WHY_NO_RANKS = why_no_ranks()


class Experiments(ProgramTest):
    def study(self, **changes):
        return self.write("tiny.json", json.dumps({**STUDY, **changes}))

    def experiment(self, *arguments, **options):
        return dssbench("experiment", self.path("tiny.json"), "--scale", "smoke", "--out", self.path("out"), *arguments, **options)

    def rows(self, name):
        with open(self.path(f"out/{name}/tiny.csv"), encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_every_repetition_is_checked_and_recorded(self):
        self.study()
        result = self.experiment()
        self.assertEqual(result.returncode, 0, result.stderr + result.stdout)
        raw = self.rows("raw")
        self.assertEqual(len(raw), 6)
        for row in raw:
            self.assertEqual((row["check"], row["status"]), ("passed", "ok"))
            self.assertGreater(float(row["check_error"]), 0)
            self.assertGreater(float(row["check_tail_error"]), 0)
            self.assertGreater(float(row["wall_s"]), 0)
        table = self.rows("tables")
        self.assertEqual([row["source"] for row in table], ["measured"] * 3 + ["paper"])
        self.assertGreater(float(table[1]["speedup_vs_reference"]), 1)
        self.assertEqual((table[3]["paper_wall_s"], table[3]["measured_wall_s"]), ("12.5", ""))
        self.assertTrue(json.loads(self.read("out/raw/tiny.json"))["context"]["denormals_flushed"])
        self.assertIn(self.path("out/tables/tiny.csv"), result.stdout)

    def test_resume_measures_only_what_is_missing(self):
        self.study()
        self.experiment()
        lines = self.read("out/raw/tiny.csv").splitlines(keepends=True)
        kept = lines[:4]
        self.write("out/raw/tiny.csv", "".join(kept) + lines[4][:30])
        self.assertEqual(self.experiment("--resume").returncode, 0)
        resumed = self.read("out/raw/tiny.csv").splitlines(keepends=True)
        self.assertEqual(resumed[:4], kept)
        self.assertEqual(len(resumed), 7)
        self.assertEqual(self.experiment("--resume").returncode, 0)
        self.assertEqual(self.read("out/raw/tiny.csv").splitlines(keepends=True), resumed)

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
        self.assert_refused(2, ["pair.json", "has changed"], "experiment", self.path("tiny.json"), "--scale", "smoke", "--resume", "--out",
                            self.path("out"))
        circumstances = json.loads(self.read("out/raw/tiny.json"))
        circumstances["context"]["git_commit"] = "another"
        self.write("out/raw/tiny.json", json.dumps(circumstances))
        self.assert_refused(2, ["git_commit", "another"], "experiment", self.path("tiny.json"), "--scale", "smoke", "--resume", "--out",
                            self.path("out"))

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
        self.assert_refused(2, ['"smoke"', '"trial"', "--out"], "experiment", self.path("tiny.json"), "--scale", "trial", "--out", self.path("out"))
        self.assertEqual(self.read("out/raw/tiny.csv"), before)
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (512, 512))  # noqa: E731
        result = dssbench("experiment", self.path("tiny.json"), "--scale", "smoke", "--out", self.path("out"), preexec_fn=limit)
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        kept = self.path("out/raw/tiny.csv.previous") if os.path.exists(self.path("out/raw/tiny.csv.previous")) else self.path("out/raw/tiny.csv")
        self.assertEqual(self.read(kept), before)

    def test_a_killed_experiment_takes_its_measuring_process_along(self):
        scale = {**STUDY["scales"]["smoke"], "steps": 100000000, "oracle_steps": 1}
        self.study(cells=[{**STUDY["cells"][0], "variants": ["scalar"]}], base=["scalar"], scales={"smoke": scale})
        mark = self.path("tiny.json")
        run = subprocess.Popen([PROGRAM, "experiment", mark, "--scale", "smoke", "--out", self.path("out")], stdout=subprocess.DEVNULL)
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

    def test_compare_fails_where_cells_are_missing_and_refuses_where_all_are(self):
        columns = "experiment,scale,cell,repetition,wall_s,steps,check,status,twin\n"
        rows = {cell: "".join(f"t,host,{cell},{r},{1 + 0.001 * r},10,passed,ok,false\n" for r in range(10)) for cell in "abc"}
        old, new, other = (self.write(name, columns + text) for name, text in
                           (("o.csv", rows["a"] + rows["b"]), ("n.csv", rows["a"]), ("c.csv", rows["c"])))
        result = dssbench("compare", old, new)
        self.assertEqual((result.returncode, "only in OLD" in result.stdout), (1, True))
        self.assertEqual(dssbench("compare", new, old).returncode, 0)
        self.assert_refused(2, ["no cell in common"], "compare", old, other)

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
        scale = {**STUDY["scales"]["smoke"], "steps": 300000, "steps_for": {"scalar": 40}, "time_limit_s": 1}
        self.study(scales={"smoke": scale})
        self.assertEqual(self.experiment().returncode, 1)
        table = {row["label"]: row for row in self.rows("tables")}
        self.assertEqual(table["reference, 1 thread"]["status"], "time limit")
        self.assertEqual(table["reference, 1 thread"]["reason"], "time limit of 1 s")
        self.assertEqual(table["scalar, 1 thread"]["status"], "ok")
        self.assertEqual(table["scalar, 1 thread"]["speedup_vs_reference"], "")
        self.assertGreater(float(table["scalar, 1 thread"]["extrapolated_wall_s"]), 0)

    def test_a_cell_that_the_program_refuses_is_recorded_with_its_reason(self):
        self.study(cells=[{"scene": "plate_paper", "set": {"n": 10, "run.dt": [1e-6, 1e-5]}, "variants": ["reference", "scalar"]}])
        self.assertEqual(self.experiment().returncode, 1)
        statuses = {(row["set"], row["status"]) for row in self.rows("tables") if row["source"] == "measured"}
        self.assertEqual({status for set_text, status in statuses if "1e-05" not in set_text}, {"ok"})
        refused = [row for row in self.rows("tables") if "1e-05" in row["set"]]
        self.assertEqual({row["status"] for row in refused}, {"failed"})
        self.assertIn("stability limit", refused[0]["reason"])
        self.assertEqual({row["speedup_vs_reference"] for row in refused}, {""})

    def test_a_study_of_step_limits_writes_what_it_predicts_and_measures(self):
        result = dssbench("experiment", "stability", "--scale", "smoke", "--out", self.path("out"))
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        tables = {}
        for name in ("stability", "stability_energy", "stability_map"):
            with open(self.path(f"out/tables/{name}.csv"), encoding="utf-8") as file:
                tables[name] = list(csv.DictReader(file))
        methods = {row["integrator"] for row in tables["stability"]}
        for scene in ("one_mode", "two_elements", "chain", "cantilever_beam"):
            self.assertEqual({row["integrator"] for row in tables["stability"] if row["scene"] == scene}, methods)
        for row in tables["stability"]:
            self.assertEqual(row["status"], "ok", row)
            self.assertAlmostEqual(float(row["ratio"]), 1, delta=0.01)
        self.assertEqual({row["status"] for row in tables["stability_energy"]}, {"ok"})
        self.assertEqual({row["integrator"] for row in tables["stability_map"]}, methods)
        most = [row for row in tables["stability_energy"] if row["integrator"] == "rk4" and abs(float(row["h_omega"]) ** 2 - 6) < 1e-9]
        self.assertAlmostEqual(float(most[0]["measured_energy_change_per_step"]), -0.75, delta=1e-9)

    def test_a_study_of_step_limits_that_is_wrong_says_where_and_keeps_earlier_tables(self):
        os.makedirs(self.path("out/tables"))
        self.write("out/tables/limits.csv", "earlier")
        mode = {"scene": os.path.join(SCENES, "../stability/one_mode.json"), "zeta": [0]}
        good = {"experiment": "limits", "title": "t", "stability": {"mode": mode, "scenes": []},
                "scales": {"smoke": {"energy_points": 3, "map_points": 3}}}
        for change, words in (({"mode": {**mode, "zeta": [-1]}}, ["/stability/mode/zeta/0", "at least 0"]),
                              ({"mode": {**mode, "scene": "two_elements"}}, ["/stability/mode/scene", "omega"]),
                              ({"variant": "avx3"}, ["/stability/variant", "avx2"]),
                              ({"scenes": [{"scene": "chian"}]}, ["chian", "chain"]),
                              ({"modes": mode}, ["modes", "mode"])):
            study = self.write("limits.json", json.dumps({**good, "stability": {**good["stability"], **change}}))
            self.assert_refused(2, words, "experiment", study, "--scale", "smoke", "--out", self.path("out"))
        self.assert_refused(2, ["--scale", "smoke"], "experiment", self.write("limits.json", json.dumps(good)), "--scale", "smok", "--out", self.path("out"))
        self.assertEqual(self.read("out/tables/limits.csv"), "earlier")

    def test_a_wrong_state_keeps_its_time_and_fails(self):
        self.study()
        self.experiment()
        states = [name for name in os.listdir(self.path("out/oracle")) if name.endswith(".state")]
        self.assertEqual(len(states), 1)
        with open(self.path("out/oracle/" + states[0]), "r+b") as file:
            file.seek(-8 * 13 * 3, os.SEEK_END)
            file.write(b"\x00" * 8)
        arguments = ("run", "plate_paper", "--set", "n=10", "--steps", "40", "--check-state", self.path("out/oracle/" + states[0]))
        result = dssbench(*arguments, "--json", "-")
        record = json.loads(result.stdout)
        self.assertEqual((result.returncode, record["status"], record["check"]), (1, "wrong", "failed"))
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
            ({"cells": [{"scene": "plate_paper", "set": {"n": [10, 10]}, "variants": ["scalar"]}], "base": ["scalar"]}, ["/cells", "twice"]),
            ({"scales": {"smoke": {"steps": -1}}}, ["/scales/smoke/steps", "-1"]),
            ({"cells": [{"scene": "plate_paper", "variants": ["scalar"], "models": ["flat"]}]}, ["/cells/0/models", "flat"]),
            ({"cells": [{"scene": "plate_papr", "variants": ["scalar"]}]}, ["/cells/0", '"plate_paper"']),
            ({"cells": [{"scene": "plate_paper", "set": {"m": 10}, "variants": ["scalar"]}]}, ["/cells/0", "m"]),
            ({"cells": [{"scene": "plate_paper", "set": {"n": -3}, "variants": ["scalar"]}]}, ["/cells/0", "/geometry/box"]),
            ({"cells": [{"scene": "plate_bending", "variants": ["scalar"], "models": ["planar"]}]}, ["/cells/0", "planar"]),
            ({"cells": [{"scene": "plate_paper", "variants": ["scaler"]}]}, ["/cells/0/variants", '"scalar"']),
            ({"scales": {"smoke": {"steps": 40, "steps_by_set": {"n=11": 9}}}}, ["/scales/smoke/steps_by_set", "n=11", "n=10"]),
        ):
            self.study(**changes)
            self.assert_refused(2, words, "experiment", self.path("tiny.json"), "--scale", "smoke", "--out", self.path("out"))
            self.assert_refused(2, words, "experiment", self.path("tiny.json"), "--scale", "smoke", "--dry-run")
        self.assertEqual(self.read("out/raw/tiny.csv"), before)

    def test_a_dry_run_lists_the_cells_and_writes_nothing(self):
        self.study()
        result = self.experiment("--dry-run")
        self.assertEqual(result.returncode, 0)
        self.assertIn("3 cells", result.stdout)
        self.assertFalse(os.path.exists(self.path("out")))

    def test_compare_finds_what_became_slower(self):
        columns = "experiment,scale,cell,repetition,wall_s,steps,check,status,twin\n"
        old = columns + "".join(f"t,host,a,{r},{1 + 0.001 * r},10,passed,ok,false\n" for r in range(10))
        new = columns + "".join(f"t,host,a,{r},{1.5 + 0.001 * r},10,passed,ok,false\n" for r in range(10))
        before, after = self.write("old.csv", old), self.write("new.csv", new)
        for first, second, exit_code, verdict in ((before, after, 1, "slower"), (after, before, 0, "faster"), (before, before, 0, "same")):
            result = dssbench("compare", first, second)
            self.assertEqual(result.returncode, exit_code, result.stdout)
            self.assertIn(verdict, result.stdout)

    def test_compare_makes_no_claim_of_wrong_states_and_fails_where_they_are_new(self):
        columns = "experiment,scale,cell,repetition,wall_s,steps,check,status,twin\n"
        right = self.write("right.csv", columns + "".join(f"t,host,a,{r},{1 + 0.001 * r},10,passed,ok,false\n" for r in range(10)))
        wrong = self.write("wrong.csv", columns + "".join(f"t,host,a,{r},{0.5 + 0.001 * r},10,failed,wrong,false\n" for r in range(10)))
        for first, second, exit_code in ((right, wrong, 1), (wrong, right, 0)):
            result = dssbench("compare", first, second)
            self.assertEqual(result.returncode, exit_code, result.stdout)
            self.assertIn("no claim: wrong", result.stdout)
            self.assertNotIn("faster", result.stdout)

    def test_steps_by_set_give_each_size_its_own_number(self):
        cells = [{"scene": "plate_paper", "set": {"n": [10, 12]}, "variants": ["reference", "scalar"]}]
        scale = {**STUDY["scales"]["smoke"], "steps_by_set": {"n=12": 30}, "steps_for": {"reference": 35}}
        self.study(cells=cells, scales={"smoke": scale})
        self.assertEqual(self.experiment().returncode, 0)
        steps = {(row["set"], row["variant"], row["steps"]) for row in self.rows("tables") if row["source"] == "measured"}
        self.assertEqual(steps, {("n=10", "reference", "35"), ("n=10", "scalar", "40"), ("n=12", "reference", "30"), ("n=12", "scalar", "30")})

    def test_compare_refuses_what_is_no_result(self):
        self.assert_refused(2, ["x.csv", '"cell"'], "compare", self.write("x.csv", "a,b\n1,2\n"), self.path("x.csv"))


class ExperimentsOnRanks(ProgramTest):
    """Studies whose cells are jobs of several processes."""

    study, experiment, rows = Experiments.study, Experiments.experiment, Experiments.rows

    def study_on_ranks(self, **changes):
        block = {"scene": "plate_paper", "set": {"n": [10]}, "variants": ["scalar"], "ranks": [1, 2], "halos": ["deep", "auto"]}
        scale = {**STUDY["scales"]["smoke"], "steps": 100}
        self.study(cells=[{**block, **changes}], base=["scalar"], scales={"smoke": scale})

    def measured(self):
        return {row["label"]: row for row in self.rows("tables") if row["source"] == "measured"}

    @unittest.skipIf(WHY_NO_RANKS, WHY_NO_RANKS)
    def test_cells_on_ranks_are_checked_and_scale(self):
        self.study_on_ranks(weak={"parameter": "n", "power": 2})
        result = self.experiment()
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        on_ranks = [row for row in self.rows("raw") if row["ranks"] == "2"]
        self.assertEqual(len(on_ranks), 2 * 2)
        for row in on_ranks:
            self.assertEqual((row["check"], row["status"], row["decomposition"], row["set"], row["elements"]), ("passed", "ok", "strips", "n=14", "196"))
            self.assertGreater(float(row["messages_per_step"]), 0)
            self.assertGreater(float(row["bytes_per_step"]), 0)
            self.assertGreaterEqual(float(row["imbalance"]), 1)
            self.assertGreaterEqual(float(row["communication_share"]), 0)
            self.assertEqual(row["workers"], "2")
        self.assertEqual({row["halo_used"] for row in on_ranks if row["halo"] == "deep"}, {"deep"})
        self.assertNotIn("auto", {row["halo_used"] for row in on_ranks})
        cores = int(on_ranks[0]["cores"])
        deep = self.measured()["scalar, 2 ranks x 1 thread, halo deep"]
        self.assertEqual(deep["status"], "ok" if cores > 1 else "oversubscribed")
        self.assertEqual(deep["weak_efficiency"] != "", cores > 1)
        self.assertIn("Over ranks", result.stdout)

    @unittest.skipIf(WHY_NO_RANKS, WHY_NO_RANKS)
    def test_more_ranks_than_cores_are_marked_and_not_retried(self):
        ranks = len(os.sched_getaffinity(0)) + 1
        self.study_on_ranks(ranks=[1, ranks], halos=["deep"])
        result = self.experiment()
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        row = self.measured()[f"scalar, {ranks} ranks x 1 thread, halo deep"]
        self.assertEqual((row["status"], row["speedup_vs_1_rank"], row["parallel_efficiency"], row["karp_flatt"]), ("oversubscribed", "", "", ""))
        self.assertGreater(float(row["measured_wall_s"]), 0)
        self.assertEqual({row["attempt"] for row in self.rows("raw") if row["ranks"] == str(ranks)}, {"0"})

    @unittest.skipIf(WHY_NO_RANKS, WHY_NO_RANKS)
    def test_a_rank_that_dies_fails_its_cells_and_the_rest_goes_on(self):
        self.study_on_ranks()
        result = self.experiment(env={**os.environ, "DSSBENCH_FAULT": "die:1:50"})
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        table = self.measured()
        self.assertEqual((table["scalar, 1 thread"]["status"], table["scalar, 1 thread"]["repetitions"]), ("ok", "2"))
        for halo in ("deep", "auto"):
            row = table[f"scalar, 2 ranks x 1 thread, halo {halo}"]
            self.assertEqual((row["status"], row["measured_wall_s"], row["speedup_vs_1_rank"]), ("failed", "", ""))
            self.assertIn("rank 1 of 2 was ended by signal 9", row["reason"])

    def test_without_mpirun_cells_on_ranks_are_skipped_with_the_reason(self):
        self.study_on_ranks()
        result = self.experiment(env={**os.environ, "PATH": self.directory})
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        table = self.measured()
        self.assertEqual(table["scalar, 1 thread"]["status"], "ok")
        row = table["scalar, 2 ranks x 1 thread, halo deep"]
        self.assertEqual(row["status"], "skipped")
        self.assertRegex(row["reason"], "mpirun is not installed|MPI")

    def test_wrong_ranks_are_refused_with_their_place(self):
        for changes, words in (
            ({"ranks": ["two"]}, ["/cells/0/ranks/0", "two"]),
            ({"halos": ["depe"]}, ["/cells/0/halos", '"deep"']),
            ({"decompositions": ["strip"]}, ["/cells/0/decompositions", '"strips"']),
            ({"variants": ["scalar", "reference"]}, ["/cells/0/ranks", '"reference"', "1 rank"]),
            ({"weak": {"parameter": "m", "power": 2}}, ["/cells/0/weak/parameter", '"m"']),
        ):
            self.study_on_ranks(**changes)
            self.assert_refused(2, words, "experiment", self.path("tiny.json"), "--scale", "smoke", "--dry-run")

    def test_lines_over_ranks_come_of_a_table(self):
        columns = ("source,scene,set,variant,model,precision,integrator,threads,cores,label,ranks,decomposition,halo,status,element_steps_per_s,"
                   "communication_share,speedup_vs_1_rank,speedup_vs_1_rank_low,speedup_vs_1_rank_high,weak_base_set,weak_efficiency,"
                   "weak_efficiency_low,weak_efficiency_high\n")
        plate = "measured,plate_paper,n=10,avx2,spatial,f64,rk4,1,2"
        rows = [f"{plate},one,1,,,ok,1e6,,,,,n=10,,,",
                f"{plate},two,2,strips,deep,ok,1.8e6,0.1,1.8,1.7,1.9,,,,",
                f"{plate},four,4,strips,deep,oversubscribed,1.6e6,0.5,,,,,,,",
                f"{plate},weak,2,strips,auto,ok,1.9e6,0.05,,,,n=10,0.95,,".replace("n=10,avx2", "n=14,avx2"),
                ",".join(["paper"] + [""] * 22)]
        self.write("t.csv", columns + "\n".join(rows) + "\n")
        self.write("old.csv", "source,label\nmeasured,a\n")
        for name, exit_code in (("t", 0), ("old", 1)):
            command = [sys.executable, os.path.join(PLOTS, "scaling_lines.py"), self.path(f"{name}.csv"), "--output", self.path(f"{name}.png")]
            result = subprocess.run(command, capture_output=True, text=True)
            if "ModuleNotFoundError" in result.stderr:
                self.skipTest("this python has no matplotlib or no pandas")
            self.assertEqual(result.returncode, exit_code, result.stderr)
            self.assertEqual(os.path.exists(self.path(f"{name}.png")), exit_code == 0)
        self.assertIn("speedup_vs_1_rank", result.stderr)
        self.assertNotIn("Traceback", result.stderr)


class ExperimentsOnDevices(ProgramTest):
    """Studies whose cells are on devices or hybrids."""

    study, experiment, rows = Experiments.study, Experiments.experiment, Experiments.rows

    def blocks(self, *more):
        self.study(cells=[{"scene": "plate_paper", "set": {"n": [10]}, "variants": ["scalar"]}, *more], base=["scalar"], twin="scalar")

    def test_without_its_device_a_cell_is_unavailable_and_the_study_succeeds(self):
        plate = {"scene": "plate_paper", "set": {"n": [10]}}
        self.blocks({**plate, "variants": ["opencl", "opencl-rhs"], "device": "no such device"},
                    {**plate, "hybrid": ["scalar,opencl@[9:9]"]},
                    {**plate, "hybrid": "auto", "device": "no such device"})
        result = self.experiment()
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        for name in ("raw", "tables"):
            absent = [row for row in self.rows(name) if row["status"] == "unavailable"]
            self.assertEqual(len(absent), 4)
            for row in absent:
                self.assertNotEqual(row["reason"], "")
                self.assertEqual((row.get("wall_s", ""), row.get("measured_wall_s", ""), row["device_used"], row["members"]), ("", "", "", ""))
        self.assertEqual({row["status"] for row in self.rows("tables") if row["variant"] == "scalar"}, {"ok"})
        self.assertIn("unavailable: ", result.stdout)

    def test_cells_on_devices_have_their_costs_and_hybrids_their_shares(self):
        listed = json.loads(dssbench("list", "devices", "--json").stdout)
        if not any(device["kind"] == "cpu" and device["status"] == "usable" for device in listed[1:]):
            self.skipTest("no OpenCL device of the kind cpu")
        plate = {"scene": "plate_paper", "set": {"n": [10]}}
        self.blocks({**plate, "variants": ["opencl", "opencl-rhs"], "device": "cpu"}, {**plate, "variants": ["avx2"]},
                    {**plate, "hybrid": "avx2:1,opencl@cpu:1"})
        result = self.experiment()
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        table = {row["variant"]: row for row in self.rows("tables") if row["source"] == "measured"}
        for variant in ("opencl", "opencl-rhs"):
            row = table[variant]
            self.assertEqual((row["device"], row["status"], row["check"]), ("cpu", "ok", "passed"))
            for column in ("launch_us", "first_step_s", "build_s", "triad_bytes_per_s", "bandwidth_share", "peak_share"):
                self.assertGreater(float(row[column]), 0, column)
        self.assertGreater(float(table["opencl-rhs"]["to_device_bytes_per_step"]), float(table["opencl"]["to_device_bytes_per_step"]))
        self.assertGreater(float(table["opencl-rhs"]["speedup_vs_resident"]), 0)
        hybrid = table["hybrid"]
        self.assertRegex(hybrid["members"], r"^avx2:1 0\.\d+; opencl@cpu:1 0\.\d+$")
        self.assertGreater(float(hybrid["of_sum_of_members"] or 1), 0)
        self.assertIn("On devices", result.stdout)
        self.assertIn("Hybrids", result.stdout)

    def test_a_balance_is_modelled(self):
        balance = {"slow_element_steps_per_s": 1e8, "speed_ratios": [1, 50], "n": [50], "links": [{"label": "L", "latency_us": 10, "gb_per_s": 12}]}
        self.write("tiny.json", json.dumps({"experiment": "tiny", "title": "T", "balance": balance, "scales": {}}))
        result = self.experiment()
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual({row["status"] for row in self.rows("tables")}, {"modelled"})
        self.write("tiny.json", json.dumps({"experiment": "tiny", "title": "T", "balance": {**balance, "speed_ratios": [0]}, "scales": {}}))
        self.assert_refused(2, ["/balance/speed_ratios", "0"], "experiment", self.path("tiny.json"), "--scale", "smoke")


if __name__ == "__main__":
    unittest.main()
