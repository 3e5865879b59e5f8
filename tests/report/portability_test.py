"""Tests the metric of performance portability, and the command that prints it."""
import csv
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

import report

try:
    import pandas  # noqa: F401
    from matplotlib.figure import Figure  # noqa: F401
except ImportError as missing:
    report.skip_all(f"this python has no {missing.name}")
sys.path.insert(0, str(report.ROOT / "plots"))
from tables import portability  # noqa: E402

COLUMNS = ("label", "scene", "set", "variant", "model", "precision", "integrator", "status",
           "device", "device_used", "measured_wall_s", "measured_wall_low_s",
           "measured_wall_high_s", "element_steps_per_s", "peak_share", "bandwidth_share")


def write_results(folder, cores, cells):
    """Results of one machine. cells: (variant, rate, device_used, peak_share, more)"""
    for name in ("tables", "raw"):
        (folder / name).mkdir(parents=True)
    context = {"cpu_model": "Some(R) CPU Processor", "num_cpus": cores, "git_commit": "1" * 40}
    (folder / "raw" / "table3.json").write_text(json.dumps({"context": context}))
    with open(folder / "tables" / "table3.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        for variant, rate, device, share, more in cells:
            wall = 100 / rate
            writer.writerow({
                "label": variant, "scene": "plate", "set": "n=9", "variant": variant,
                "model": "spatial", "precision": "f64", "integrator": "rk4", "status": "ok",
                "device": "0:0" if device else "", "device_used": device, "measured_wall_s": wall,
                "measured_wall_low_s": wall / 1.1, "measured_wall_high_s": wall / 0.9,
                "element_steps_per_s": rate, "peak_share": share, **more})


class Portability(unittest.TestCase):
    """Two machines; the second one has a GPU."""

    def setUp(self):
        holder = tempfile.TemporaryDirectory(prefix="dssbench-portability-")
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)
        self.one, self.two = self.folder / "one", self.folder / "two"
        write_results(self.one, 2, [
            ("avx2", 40, "", "", {}), ("avx2", 80, "", "", {}),
            ("avx2", 900, "", "", {"status": "wrong"}),
            ("opencl", 40, "0:0 pthread-Some(R) CPU Processor", 0.25, {"bandwidth_share": 0.5}),
            ("hybrid", 1000, "", "", {}), ("avx2", 800, "", "", {"label": "avx2 (A/A)"}),
            ("avx2", 800, "", "", {"measured_wall_low_s": ""})])
        write_results(self.two, 4, [
            ("avx2", 100, "", "", {}), ("avx2", 90, "", "", {"measured_wall_low_s": 100 / 150}),
            ("opencl", 80, "0:0 pthread-Some(R) CPU Processor", 0.4, {}),
            ("opencl", 500, "1:0 A GPU", 0.01, {})])

    def by_application(self, kind="application", folders=()):
        """Efficiencies by application and platform, and portabilities by application."""
        frame = portability.efficiencies([self.one, self.two, *folders])
        return (frame.set_index(["application", "platform"]),
                portability.portabilities(frame, kind).set_index("application"))

    def run_command(self, *options):
        script = report.ROOT / "plots" / "portability.py"
        return subprocess.run([sys.executable, script, *options], capture_output=True, text=True,
                              check=False)

    def test_the_metric_is_the_harmonic_mean_or_0(self):
        cells, scores = self.by_application()
        self.assertEqual(set(cells.index.get_level_values("platform")),
                         {"Some CPU, 2 cores", "Some CPU, 4 cores", "A GPU"})
        self.assertAlmostEqual(scores.loc["opencl", "portability"],
                               3 / (1 / 0.5 + 1 / 0.8 + 1 / 1.0))
        self.assertEqual(scores.loc["avx2", "portability"], 0)
        self.assertEqual(scores.loc["avx2", "mean"], 1)
        self.assertEqual(set(scores.index), {"avx2", "opencl"})

    def test_intervals_take_both_times_at_their_worst(self):
        cells, scores = self.by_application()
        cell = cells.loc["opencl", "Some CPU, 2 cores"]
        self.assertAlmostEqual(cell["application_efficiency_low"], 40 * 0.9 / (80 * 1.1))
        self.assertAlmostEqual(cell["application_efficiency_high"], 40 * 1.1 / (80 * 0.9))
        row = scores.loc["opencl"]
        self.assertAlmostEqual(row["portability_low"],
                               3 / (88 / 36 + 150 / 72 + 1))

    def test_the_fastest_application_may_not_be_the_fastest(self):
        cells, _ = self.by_application()
        cell = cells.loc["avx2", "Some CPU, 4 cores"]
        self.assertEqual(cell["application_efficiency"], 1)
        self.assertAlmostEqual(cell["application_efficiency_low"], 90 / max(90, 88))
        self.assertAlmostEqual(cells.loc["opencl", "Some CPU, 4 cores"]
                               ["application_efficiency_high"], 88 / 90)

    def test_the_nearer_roof_counts_for_all_applications_of_a_platform(self):
        cells, scores = self.by_application("architecture")
        shares = cells["architecture_efficiency"]
        self.assertAlmostEqual(shares["opencl", "Some CPU, 2 cores"], 0.5)
        self.assertAlmostEqual(shares["avx2", "Some CPU, 2 cores"], 1.0)
        self.assertAlmostEqual(shares["opencl", "A GPU"], 0.01)
        self.assertAlmostEqual(scores.loc["opencl", "portability"],
                               3 / (1 / 0.5 + 1 / 0.4 + 1 / 0.01))

    def test_a_platform_without_a_roof_makes_the_metric_unknown_not_0(self):
        three = self.folder / "three"
        write_results(three, 8, [("avx2", 10, "", "", {}), ("opencl", 9, "2:0 B GPU", "", {})])
        _, scores = self.by_application("architecture", [three])
        self.assertEqual(scores.loc["avx2", "portability"], 0)
        self.assertEqual(scores.loc["opencl", "portability"], 0)  # not measured on 8 cores
        write_results(self.folder / "four", 16, [("opencl", 9, "3:0 C GPU", "", {})])
        frame = portability.efficiencies([self.one, self.folder / "four"])
        scores = portability.portabilities(frame, "architecture").set_index("application")
        self.assertTrue(math.isnan(scores.loc["opencl", "portability"]))
        self.assertTrue(any("unknown" in line
                            for line in portability.table_of(frame, "architecture")[1]))

    def test_the_cascade_falls_from_the_best_platform(self):
        frame = portability.cascade(portability.efficiencies([self.one, self.two]))
        own = frame[frame["application"] == "opencl"].sort_values("place")
        self.assertEqual(list(own["place"]), [1, 2, 3])
        self.assertEqual(list(own["platform"])[0], "A GPU")
        self.assertTrue(own["application_efficiency"].is_monotonic_decreasing)

    def test_problems_of_several_precisions_stay_apart(self):
        for folder, cores in ((self.folder / "a", 1), (self.folder / "b", 3)):
            write_results(folder, cores, [("avx2", 10, "", "", {"set": ""}),
                                          ("avx2", 20, "", "", {"set": "", "precision": "f32"})])
        frame = portability.efficiencies([self.folder / "a", self.folder / "b"])
        self.assertEqual(set(frame["problem"]), {"plate f64", "plate f32"})
        self.assertEqual(len(frame), 4)

    def test_platforms_of_one_name_are_two(self):
        write_results(self.folder / "twin", 2, [("avx2", 70, "", "", {})])
        cells, _ = self.by_application(folders=[self.folder / "twin"])
        self.assertIn(f"Some CPU, 2 cores of {self.folder / 'twin'}",
                      cells.index.get_level_values("platform"))

    def test_the_command_prints_draws_and_writes(self):
        picture, table = self.folder / "cascade.png", self.folder / "all.csv"
        result = self.run_command(self.one, self.two, "--figure", picture, "--csv", table)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stdout, r"`opencl` +\| 0\.5 \[0\.41, 0\.61\] .*\| 0\.71 ")
        self.assertGreater(picture.stat().st_size, 10000)
        with open(table, encoding="utf-8") as file:
            self.assertEqual(len(list(csv.DictReader(file))), 5)

    def test_what_cannot_be_compared_is_one_line(self):
        none, table = self.folder / "none", self.folder / "all.csv"
        for options, words in (([self.one], "no problem has two platforms"),
                               ([self.one, none], f"{none}, table3: not measured"),
                               ([self.one, self.one], "named twice"),
                               ([self.one, self.two, "--table", "table9"], "table9: not measured"),
                               ([self.one, self.two, "--figure", none / "a.png"],
                                "no such folder")):
            result = self.run_command(*options, "--csv", table)
            self.assertEqual(result.returncode, 1)
            self.assertIn(words, result.stderr)
            self.assertEqual(len(result.stderr.splitlines()), 1)
            self.assertFalse(table.exists())
        result = self.run_command(self.one, self.two, "--csv", self.one / "tables" / "table3.csv")
        self.assertIn("name a file outside", result.stderr)


if __name__ == "__main__":
    unittest.main()
