"""`sweep`: a study of combinations without a file."""
import csv
import json
import os
import shutil
import unittest

from program import ProgramTest, dssbench

SWEEP = ["plate_paper", "--set", "n=8,12", "--variant", "reference,scalar"]


class Sweep(ProgramTest):
    def sweep(self, *arguments):
        # A small budget: it does not wait for a quiet machine.
        return dssbench("sweep", *arguments, "--budget", 1, "--out", self.path("out"))

    def refused(self, words, *arguments):
        self.assert_refused(2, words, "sweep", *arguments, "--out", self.path("out"))

    def table(self, name):
        with open(self.path(f"out/tables/{name}.csv"), encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def study(self, name):
        return json.loads(self.read(f"out/{name}.json"))

    def test_every_combination_is_a_checked_row_with_an_interval(self):
        result = self.sweep(*SWEEP, "--precision", "f64,f32", "--steps", 20)
        self.assertEqual(result.returncode, 0, result.stderr + result.stdout)
        rows = self.table("sweep_plate_paper")
        cells = {(row["set"], row["variant"], row["precision"]) for row in rows}
        self.assertEqual(len(cells), 8)
        self.assertEqual(len(rows), 8 + 4)  # and the A/A pairs of the base
        for row in rows:
            self.assertEqual((row["status"], row["check"], row["steps"]), ("ok", "passed", "20"))
            self.assertLessEqual(float(row["speedup_vs_reference_low"]),
                                 float(row["speedup_vs_reference_high"]))
        for figure in ("sweep_plate_paper.png", "sweep_plate_paper_rates.png"):
            self.assertTrue(os.path.exists(self.path(f"out/figures/{figure}")), result.stderr)

    def test_a_trial_finds_the_steps_that_a_sample_needs(self):
        result = self.sweep(*SWEEP, "--sample-time", 0.004, "--repetitions", 1, "--no-picture")
        self.assertEqual(result.returncode, 0, result.stderr + result.stdout)
        scale = self.study("sweep_plate_paper")["scales"]["sweep"]
        self.assertEqual(set(scale["steps_by_set"]), {"n=8", "n=12"})
        for n, most in scale["steps_by_set"].items():
            steps = [scale["steps_for"][f"{variant} {n}"] for variant in ("reference", "scalar")]
            self.assertEqual(max(steps), most)
            self.assertGreater(min(steps), 2)
        self.assertEqual(len(scale["steps_for"]), 4)
        self.assertFalse(os.path.exists(self.path("out/figures")))

    def test_several_keys_are_combined_and_the_base_is_measured_too(self):
        result = self.sweep("plate_paper", "--set", "n=6,8", "--set", "run.dt=5e-7,1e-6",
                            "--variant", "scalar", "--base", "reference", "--steps", 4,
                            "--repetitions", 1)
        self.assertEqual(result.returncode, 0, result.stderr + result.stdout)
        rows = self.table("sweep_plate_paper")
        self.assertEqual(len({row["set"] for row in rows}), 4)
        self.assertEqual({row["variant"] for row in rows}, {"reference", "scalar"})
        self.assertIn("sweep_plate_paper_rates.png", result.stdout)

    @unittest.skipIf(shutil.which("mpirun") is None, "no mpirun")
    def test_ranks_have_a_trial_too(self):
        result = self.sweep("plate_paper", "--set", "n=12", "--variant", "scalar", "--ranks",
                            "1,2", "--halo", "deep", "--sample-time", 0.002, "--repetitions", 1,
                            "--no-picture")
        self.assertEqual(result.returncode, 0, result.stderr + result.stdout)
        ranks = [row["ranks"] for row in self.table("sweep_plate_paper")
                 if row["status"] in ("ok", "oversubscribed")]
        self.assertEqual(sorted(ranks), ["1", "1", "2"])

    def test_numbers_of_members_are_a_choice_too(self):
        result = self.sweep("plate_paper", "--set", "n=8", "--variant", "scalar", "--ensemble",
                            "1,8", "--sample-time", 0.002, "--repetitions", 1, "--no-picture")
        self.assertEqual(result.returncode, 0, result.stderr + result.stdout)
        rows = self.table("sweep_plate_paper")
        self.assertEqual({row["status"] for row in rows}, {"ok"})
        self.assertEqual({row["set"] for row in rows}, {"n=8", "ensemble=8 n=8"})

    def test_the_device_is_that_of_the_variants_that_compute_on_one(self):
        result = self.sweep("two_elements", "--variant", "scalar,opencl", "--device", "cpu",
                            "--dry-run")
        self.assertEqual(result.returncode, 0, result.stderr)
        cells = [line for line in result.stdout.splitlines() if line.startswith("two_elements")]
        self.assertFalse([line for line in cells if "scalar on" in line], result.stdout)
        self.assertEqual(sum("opencl" in line for line in cells), 1, result.stdout)
        self.assertTrue("opencl on cpu" in result.stdout or "unavailable" in result.stdout
                        or "skipped" in result.stdout, result.stdout)

    def test_a_dry_run_prints_the_cells_and_writes_nothing(self):
        for steps in ([], ["--steps", 5]):
            result = self.sweep(*SWEEP, *steps, "--dry-run")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(result.stdout.count("scalar, 1 thread"), 2, result.stdout)
            self.assertEqual("a trial finds" in result.stdout, not steps)
            self.assertFalse(os.path.exists(self.path("out")))

    def test_resume_goes_on_with_the_study_that_is_there(self):
        line = [*SWEEP, "--steps", 10, "--repetitions", 1, "--no-picture", "--name", "mine"]
        self.assertEqual(self.sweep(*line).returncode, 0)
        study, raw = self.read("out/mine.json"), self.read("out/raw/mine.csv")
        self.write("out/raw/mine.csv", "".join(raw.splitlines(keepends=True)[:3]))
        self.assertEqual(self.sweep(*line, "--resume").returncode, 0)
        self.assertEqual(self.read("out/mine.json"), study)
        resumed = self.read("out/raw/mine.csv").splitlines()
        self.assertEqual(resumed[:3], raw.splitlines()[:3])
        cells = {row["cell"] for row in csv.DictReader(resumed)}
        self.assertEqual(len(cells), 2 * 2 + 2)  # and the A/A pairs

    def test_an_earlier_study_is_never_lost(self):
        line = [*SWEEP, "--steps", 3, "--repetitions", 1, "--no-picture"]
        self.assertEqual(self.sweep(*line).returncode, 0)
        study, raw = (self.read(f"out/{name}") for name in
                      ("sweep_plate_paper.json", "raw/sweep_plate_paper.csv"))
        for words, more in [(["this sweep is there", "--resume"], []),
                            (["other choices"], ["--resume", "--base", "scalar"]),
                            (["avx3", "avx2"], ["--variant", "avx3", "--name", "new"])]:
            self.refused(words, *line, *more)
            self.assertEqual(self.read("out/sweep_plate_paper.json"), study)
            self.assertEqual(self.read("out/raw/sweep_plate_paper.csv"), raw)
            self.assertFalse(os.path.exists(self.path("out/new.json")))

    def test_a_scene_file_has_its_absolute_path_in_the_study(self):
        scenes = json.loads(dssbench("list", "scenes", "--json").stdout)
        path = next(row["path"] for row in scenes if row["scene"] == "two_elements")
        result = self.sweep(os.path.relpath(path), "--variant", "scalar", "--steps", 5,
                            "--repetitions", 1, "--no-picture")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.study("sweep_two_elements")["cells"][0]["scene"],
                         os.path.abspath(path))

    def test_mistakes_are_one_line_and_leave_no_study(self):
        for words, line in [
                (["--set n=", "n=40,80,160"], ["plate_paper", "--set", "n="]),
                (["--set n=8,,9"], ["plate_paper", "--set", "n=8,,9"]),
                (["n has values already"], ["plate_paper", "--set", "n=8", "--set", "n=9"]),
                (["avx3", "avx2"], ["plate_paper", "--variant", "avx3"]),
                (["no_scene"], ["no_scene"]),
                (["/bodies/0/geometry", "-1"], ["plate_paper", "--set", "n=-1"]),
                (["--name", "no slash"], ["plate_paper", "--name", "a/b"]),
                (["--halo", "give --ranks"], ["plate_paper", "--halo", "deep"]),
                (["reference", "--base"], ["plate_paper", "--variant", "reference", "--ranks", 2]),
                (["--ensemble", "--ranks"], ["plate_paper", "--ensemble", "8", "--ranks", "2"]),
                (["--device", "opencl"], ["plate_paper", "--device", "cpu"]),
                (["--dry-run", "--resume"], ["plate_paper", "--dry-run", "--resume"]),
                (["more than 1000"], ["plate_paper", "--set", "n=" + ",".join(["8"] * 1001)]),
                (["--sample-time"], ["plate_paper", "--sample-time", "nan"]),
                (["--resume", "there is no"], ["plate_paper", "--resume"]),
        ]:
            for steps in ([], ["--steps", 5]):
                with self.subTest(line=line):
                    more = [] if "--variant" in line else ["--variant", "scalar"]
                    self.refused(words, *line, *more, *steps)
                    self.assertFalse([name for name in os.listdir(self.directory + "/out")
                                      if name.endswith(".json")]
                                     if os.path.exists(self.path("out")) else [])
        self.write("file", "")
        self.assert_refused(2, ["--out"], "sweep", *SWEEP, "--out", self.path("file"))


if __name__ == "__main__":
    unittest.main()
