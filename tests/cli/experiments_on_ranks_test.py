"""`experiment`: studies whose cells are jobs of several processes."""
import json
import os
import shutil
import subprocess
import sys
import unittest

from program import dssbench
from tiny_study import STUDY, TinyStudyTest

PLOTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../plots")


def why_no_ranks():
    """Why cells on several ranks cannot be measured here; empty if they can."""
    mpi = [
        variant for variant in json.loads(dssbench("list", "variants", "--json").stdout)
        if variant["variant"] == "mpi"
    ]
    if not mpi:
        return "built without the variant mpi"
    return ("" if mpi[0]["status"] == "usable" else
            mpi[0]["status"]) or ("" if shutil.which("mpirun") else "mpirun is not installed")


WHY_NO_RANKS = why_no_ranks()


class ExperimentsOnRanks(TinyStudyTest):
    def study_on_ranks(self, repetitions=2, **changes):
        block = {
            "scene": "plate_paper", "set": {"n": [10]}, "variants": ["scalar"], "ranks": [1, 2],
            "halos": ["deep", "auto"]
        }
        scale = {**STUDY["scales"]["smoke"], "steps": 100, "repetitions": 2 * [repetitions]}
        self.study(cells=[{**block, **changes}], base=["scalar"], scales={"smoke": scale})

    def measured(self):
        return {row["label"]: row for row in self.rows("tables") if row["source"] == "measured"}

    @unittest.skipIf(WHY_NO_RANKS, WHY_NO_RANKS)
    def test_cells_on_ranks_are_checked_and_scale(self):
        self.study_on_ranks(6, weak={"parameter": "n", "power": 2})
        result = self.experiment()
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        rows = self.rows("raw")
        on_ranks, cores = [row for row in rows if row["ranks"] == "2"], int(rows[0]["cores"])
        if cores == 1:  # a weak scaling has no cell with more workers than cores
            self.assertEqual(on_ranks, [])
            return
        self.assertEqual(len(on_ranks), 2 * 6)
        for row in on_ranks:
            self.assertEqual(
                (row["check"], row["status"], row["decomposition"], row["set"], row["elements"]),
                ("passed", "ok", "strips", "n=14", "196"))
            self.assertGreater(float(row["messages_per_step"]), 0)
            self.assertGreater(float(row["bytes_per_step"]), 0)
            self.assertGreaterEqual(float(row["imbalance"]), 1)
            self.assertGreaterEqual(float(row["communication_share"]), 0)
            self.assertEqual(row["workers"], "2")
        self.assertEqual({row["halo_used"] for row in on_ranks if row["halo"] == "deep"}, {"deep"})
        self.assertNotIn("auto", {row["halo_used"] for row in on_ranks})
        deep = self.measured()["scalar, 2 ranks x 1 thread, halo deep"]
        self.assertEqual(deep["status"], "ok")
        self.assertNotEqual(deep["weak_efficiency"], "")
        self.assertIn("Over ranks", result.stdout)

    @unittest.skipIf(WHY_NO_RANKS, WHY_NO_RANKS)
    def test_more_ranks_than_cores_are_marked_and_not_retried(self):
        ranks = len(os.sched_getaffinity(0)) + 1
        self.study_on_ranks(ranks=[1, ranks], halos=["deep"])
        result = self.experiment()
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        row = self.measured()[f"scalar, {ranks} ranks x 1 thread, halo deep"]
        self.assertEqual(row["status"], "oversubscribed")
        for column in ("speedup_vs_1_rank", "parallel_efficiency", "karp_flatt"):
            self.assertEqual(row.get(column, ""), "", column)
        self.assertGreater(float(row["measured_wall_s"]), 0)
        self.assertEqual({row["attempt"]
                          for row in self.rows("raw")
                          if row["ranks"] == str(ranks)}, {"0"})

    @unittest.skipIf(WHY_NO_RANKS, WHY_NO_RANKS)
    def test_a_rank_that_dies_fails_its_cells_and_the_rest_goes_on(self):
        self.study_on_ranks()
        result = self.experiment(env={**os.environ, "DSSBENCH_FAULT": "die:1:50"})
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        table = self.measured()
        self.assertEqual(
            (table["scalar, 1 thread"]["status"], table["scalar, 1 thread"]["repetitions"]),
            ("ok", "2"))
        for halo in ("deep", "auto"):
            row = table[f"scalar, 2 ranks x 1 thread, halo {halo}"]
            self.assertEqual(
                (row["status"], row["measured_wall_s"], row.get("speedup_vs_1_rank", "")),
                ("failed", "", ""))
            self.assertIn("rank 1 of 2 was ended by signal 9", row["reason"])

    def test_without_mpirun_cells_on_ranks_are_skipped_with_the_reason(self):
        self.study_on_ranks()
        result = self.experiment(env={**os.environ, "PATH": self.directory})
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        table = self.measured()
        self.assertEqual(table["scalar, 1 thread"]["status"], "ok")
        row = table["scalar, 2 ranks x 1 thread, halo deep"]
        self.assertEqual(row["status"], "skipped")
        self.assertRegex(row["reason"], "mpirun is not installed|MPI|variant mpi")

    def test_wrong_ranks_are_refused_with_their_place(self):
        for changes, words in (
            ({"ranks": ["two"]}, ["/cells/0/ranks/0", "two"]),
            ({"halos": ["depe"]}, ["/cells/0/halos", '"deep"']),
            ({"decompositions": ["strip"]}, ["/cells/0/decompositions", '"strips"']),
            ({"variants": ["scalar", "reference"]}, ["/cells/0/ranks", '"reference"', "1 rank"]),
            ({"weak": {"parameter": "m", "power": 2}}, ["/cells/0/weak/parameter", '"m"']),
        ):
            self.study_on_ranks(**changes)
            self.assert_refused(2, words, "experiment", self.path("tiny.json"), "--scale", "smoke",
                                "--dry-run")

    def test_lines_over_ranks_come_of_a_table(self):
        columns = (
            "source,scene,set,variant,model,precision,integrator,threads,cores,label,ranks,"
            "decomposition,halo,status,element_steps_per_s,communication_share,speedup_vs_1_rank,"
            "speedup_vs_1_rank_low,speedup_vs_1_rank_high,weak_base_set,weak_efficiency,"
            "weak_efficiency_low,weak_efficiency_high\n")
        plate = "measured,plate_paper,n=10,avx2,spatial,f64,rk4,1,2"
        rows = [
            f"{plate},one,1,,,ok,1e6,,,,,n=10,,,",
            f"{plate},two,2,strips,deep,ok,1.8e6,0.1,1.8,1.7,1.9,,,,",
            f"{plate},four,4,strips,deep,oversubscribed,1.6e6,0.5,,,,,,,",
            f"{plate},weak,2,strips,auto,ok,1.9e6,0.05,,,,n=10,0.95,,".replace(
                "n=10,avx2", "n=14,avx2"), ",".join(["paper"] + [""] * 22)
        ]
        os.mkdir(self.path("tables"))
        self.write("tables/t.csv", columns + "\n".join(rows) + "\n")
        self.write("tables/old.csv", "source,label\nmeasured,a\n")
        command = [sys.executable, f"{PLOTS}/make_plots.py", "--results", self.directory]
        result = subprocess.run(command, capture_output=True, text=True)
        if "ModuleNotFoundError" in result.stderr:
            self.skipTest("this python has no matplotlib or no pandas")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertTrue(os.path.exists(self.path("figures/t_scaling.png")))
        self.assertFalse(os.path.exists(self.path("figures/old_scaling.png")))
        self.assertRegex(result.stdout, "old_scaling.png: tables/old.csv .* no column .*variant")


if __name__ == "__main__":
    unittest.main()
