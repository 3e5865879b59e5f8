"""`sweep`: a study of combinations without a file."""
import csv
import json
import os
import unittest

from program import ProgramTest, dssbench

SWEEP = ["plate_paper", "--set", "n=8,12", "--variant", "reference,scalar"]


class Sweep(ProgramTest):
    def sweep(self, *arguments):
        # A small budget: it does not wait for a quiet machine.
        return dssbench("sweep", *arguments, "--budget", 1, "--out", self.path("out"))

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
        self.assertEqual(set(scale["steps_for"]),
                         {f"{variant} {n}" for variant in ("reference", "scalar")
                          for n in ("n=8", "n=12")})
        for n in ("n=8", "n=12"):
            self.assertEqual(scale["steps_by_set"][n],
                             max(scale["steps_for"][f"{name} {n}"]
                                 for name in ("reference", "scalar")))
            self.assertGreater(scale["steps_for"][f"reference {n}"], 2)
        self.assertFalse(os.path.exists(self.path("out/figures")))

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

    def test_a_scene_file_is_found_from_the_folder_of_the_study(self):
        scenes = json.loads(dssbench("list", "scenes", "--json").stdout)
        path = next(row["path"] for row in scenes if row["scene"] == "two_elements")
        path = os.path.relpath(path)
        result = self.sweep(path, "--variant", "scalar", "--steps", 5, "--repetitions", 1,
                            "--no-picture")
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_mistakes_are_one_line_and_leave_no_study(self):
        for code, words, line in [
                (2, ["--set n=", "n=40,80,160"], ["plate_paper", "--set", "n="]),
                (2, ["--set n=8,,9"], ["plate_paper", "--set", "n=8,,9"]),
                (2, ["avx3", "avx2"], ["plate_paper", "--variant", "avx3"]),
                (2, ["no_scene"], ["no_scene"]),
                (2, ["/bodies/0/geometry", "-1"], ["plate_paper", "--set", "n=-1"]),
                (2, ["--name", "no slash"], ["plate_paper", "--name", "a/b"]),
                (2, ["--resume", "there is no"], ["plate_paper", "--resume"]),
        ]:
            with self.subTest(line=line):
                if "--variant" not in line:
                    line = [*line, "--variant", "scalar"]
                self.assert_refused(code, words, "sweep", *line, "--out", self.path("out"))
                self.assertEqual([name for name in os.listdir(self.path("out"))
                                  if name.endswith(".json")]
                                 if os.path.exists(self.path("out")) else [], [])


if __name__ == "__main__":
    unittest.main()
