"""`bench`, the studies of kernels and of the chain: their files, a kill, `compare`."""
import csv
import json
import os
import signal
import subprocess
import time
import unittest

from program import PROGRAM, ProgramTest, dssbench, why_no_variant

FEW = ("bench", "--kernel", "rotation,rk_update", "--variant", "scalar", "--model",
       "spatial,planar")
SHORT = ("--min-time", "0.001")


class Bench(ProgramTest):
    def records(self, out, name="kernels"):
        with open(self.path(f"{out}/raw/{name}.csv"), encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    def cells(self, out, name="kernels"):
        return sorted((row["cell"], row["repetition"]) for row in self.records(out, name))

    def test_kernels_are_checked_timed_and_tabled(self):
        result = dssbench(*FEW, *SHORT, "--repetitions", 2, "--out", self.path("out"))
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(self.path("out/tables/kernels.csv"), encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 6)  # rotation of two models, rk_update of one, two precisions
        for row in rows:
            self.assertEqual((row["check"], row["status"], row["repetitions"]),
                             ("passed", "ok", "2"))
            self.assertGreater(float(row["measured_ns_per_element"]), 0)
        with open(self.path("out/raw/kernels.json"), encoding="utf-8") as file:
            self.assertIn("hardware_counters", json.load(file)["context"])

    def test_a_run_killed_and_resumed_has_the_records_of_a_whole_one(self):
        few = (*FEW, "--repetitions", "4", "--min-time", "0.02")
        self.assertEqual(dssbench(*few, "--out", self.path("whole")).returncode, 0)
        running = subprocess.Popen(
            [PROGRAM, *few, "--out", self.path("cut")],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL)
        raw = self.path("cut/raw/kernels.csv")
        for _ in range(1000):  # until some are there
            if os.path.exists(raw) and os.path.getsize(raw) > 1500:
                break
            time.sleep(0.01)
        running.send_signal(signal.SIGKILL)
        running.wait()
        self.assertLess(len(self.records("cut")), len(self.records("whole")), "it was not cut off")
        result = dssbench(*few, "--resume", "--out", self.path("cut"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.cells("cut"), self.cells("whole"))

    def test_compare_has_a_verdict_for_each_kernel(self):
        self.assertEqual(
            dssbench(*FEW, *SHORT, "--repetitions", 9, "--out", self.path("a")).returncode, 0)
        with open(self.path("a/raw/kernels.csv"), encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        # Times are given, not measured: a neighbour of this machine must not decide the verdict.
        for name, rotation in (("old.csv", 1), ("new.csv", 3)):
            with open(self.path(name), "w", encoding="utf-8", newline="") as file:
                writer = csv.DictWriter(file, rows[0].keys())
                writer.writeheader()
                for row in rows:
                    slower = rotation if row["kernel"] == "rotation" else 1
                    wall_s = slower * (1 + 0.01 * int(row["repetition"]))
                    writer.writerow({**row, "wall_s": wall_s})
        result = dssbench("compare", self.path("old.csv"), self.path("new.csv"))
        self.assertEqual(result.returncode, 1, result.stderr)
        # rotation: two models, two precisions
        self.assertEqual(result.stdout.count("slower"), 4, result.stdout)
        self.assertIn("Mann-Whitney", result.stdout)

    @unittest.skipIf(why_no_variant("opencl"), why_no_variant("opencl"))
    def test_the_kernel_of_a_device_is_timed_by_itself(self):
        result = dssbench("bench", "--kernel", "rates", "--variant", "opencl,scalar", "--model",
                          "spatial,planar", "--n", 12, *SHORT, "--repetitions", 1, "--out",
                          self.path("out"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual({row["cell"].split("/", 1)[0]
                          for row in self.records("out")}, {"rates_12"})
        for row in self.records("out"):
            self.assertEqual((row["variant"], row["check"], row["status"]),
                             ("opencl", "passed", "ok"))
        self.assertEqual(len(self.records("out")), 4)  # two models, two precisions

    def test_attribution_keeps_the_times_of_its_rounds(self):
        cases = {"variants": "scalar", "models": "planar", "precisions": "f64", "n": 20}
        scale = {
            "repetitions": 1, "sample_s": 1e-4, "attribution_rounds": 7,
            "attribution_sample_s": 1e-4, "ceilings": False
        }
        few = {
            "kernels": "rotation", "models": "planar", "precisions": "f64", "variants": "scalar",
            "levels": "L1"
        }
        study = {
            "experiment": "tiny", "title": "Tiny",
            "microbenchmarks": {"sets": [few], "attribution": [cases]}, "scales": {"smoke": scale}
        }
        result = dssbench("experiment", self.write("study.json", json.dumps(study)), "--scale",
                          "smoke", "--out", self.path("out"))
        self.assertEqual(result.returncode, 0, result.stderr)
        rounds = self.records("out", "attribution")
        with open(self.path("out/tables/attribution.csv"), encoding="utf-8", newline="") as file:
            step = next(row for row in csv.DictReader(file) if row["part"] == "step")
        of_step = sorted(1e9 * float(row["wall_s"]) / float(row["elements"])
                         for row in rounds
                         if row["timed"] == "step")
        self.assertEqual(len(of_step), 7)
        self.assertAlmostEqual(float(step["measured_ns_per_element_step"]) / of_step[3], 1)
        self.assertAlmostEqual(float(step["measured_ns_per_element_step_low"]) / of_step[0], 1)
        self.assertLess(float(step["sum_over_step_low"]), float(step["sum_over_step_high"]))
        self.assertTrue({"stage_row", "stage_row L1", "stage_row_last", "peak"} <=
                        {row["timed"]
                         for row in rounds})

    def test_unknown_names_are_refused_with_the_nearest(self):
        self.assert_refused(2, ["rotatoin", "rotation"], "bench", "--kernel", "rotatoin", "--out",
                            self.path("out"))
        self.assert_refused(2, ["L5", "L3"], "bench", "--level", "L5", "--out", self.path("out"))
        self.assertFalse(os.path.exists(self.path("out/raw/kernels.csv")))


CHAIN = os.path.join(os.path.dirname(os.path.abspath(__file__)),
                     "../../experiments/studies/chain/chain.json")


class Chain(ProgramTest):
    def rows_of_chain(self, repetitions):
        """The chain of the paper's plate at the scale smoke."""
        with open(CHAIN, encoding="utf-8") as file:
            study = json.load(file)
        study["scales"]["smoke"]["repetitions"] = repetitions
        study["chain"]["neighbours"] = study["chain"]["neighbours"][:1]
        path = self.write("chain.json", json.dumps(study))
        result = dssbench("experiment", path, "--scale", "smoke", "--out", self.path("out"))
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(self.path("out/tables/chain.csv"), encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    def test_each_stage_has_a_factor_and_an_error(self):
        rows = self.rows_of_chain(6)
        stages = [row for row in rows if row["role"] == "stage"]
        self.assertEqual([row["integrator"] for row in stages],
                         8 * ["rk4"] + ["velocity_verlet"] + 2 * ["smoothed_verlet"])
        self.assertEqual([row["model"] for row in stages],
                         5 * ["spatial"] + 5 * ["planar"] + ["membrane"])
        for row in stages:
            self.assertEqual((row["status"], row["base"]), ("ok", "as_published"))
            self.assertLess(float(row["error_max"]), 1e-3)
            self.assertLessEqual(float(row["factor_vs_base_low"]), float(row["factor_vs_base"]))
        self.assertEqual(float(stages[0]["factor_vs_base"]), 1)
        self.assertGreater(float(stages[2]["factor_vs_base"]), 3)
        self.assertLess(float(stages[0]["oracle_error"]), 1e-12)
        neighbour = rows[-1]
        self.assertEqual((neighbour["role"], neighbour["smoothing"]), ("neighbour", "0.5"))
        # It takes the longest stable step, its stage one that is a hundredth of that.
        self.assertGreater(float(neighbour["error_max"]), float(stages[-1]["error_max"]))

    def test_a_smoke_run_does_not_look_like_a_result(self):
        for row in self.rows_of_chain(2):
            self.assertEqual([name for name in row if name.startswith("factor")], [])

    def test_a_chain_with_an_unknown_model_is_refused(self):
        study = {
            "experiment": "c", "title": "c",
            "scales": {"host": {"repetitions": 1, "sample_s": 1e-3}},
            "chain": {"scene": "plate_paper", "end_time": 1e-5, "saved_times": 1, "bar": 1,
                      "solution": {"steps_an_interval": 20},
                      "stages": [{"label": "a", "variant": "scalar", "steps_an_interval": 10},
                                 {"label": "b", "model": "planer"}]}
        }
        self.assert_refused(2, ["/chain/stages/1/model", "planer", "planar"], "experiment",
                            self.write("c.json", json.dumps(study)), "--out", self.path("out"))


if __name__ == "__main__":
    unittest.main()
