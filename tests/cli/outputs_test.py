"""What `run`, `verify`, `list` and `stability` write."""
import csv
import json
import os
import pathlib
import subprocess
import sys
import unittest

from program import ProgramTest, dssbench

ROOT = pathlib.Path(__file__).resolve().parents[2]
KEYS = """scene variant isa model precision integrator threads ranks elements links steps dt_s \
wall_s element_steps_per_s energy_j
max_displacement_m status reason schedule bytes cpu_s involuntary_switches state_digest""".split()


class Outputs(ProgramTest):
    def run_json(self, *arguments, steps=50):
        result = dssbench("run", "plate_paper", "--set", "n=12", "--steps", steps, *arguments,
                          "--json", "-")
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def test_json_has_the_documented_keys_and_the_context(self):
        record = self.run_json()
        self.assertEqual([key for key in KEYS if key not in record], [])
        self.assertEqual((record["elements"], record["links"], record["steps"], record["status"]),
                         (144, 264, 50, "ok"))
        self.assertGreater(record["wall_s"], 0)
        self.assertAlmostEqual(record["element_steps_per_s"], 144 * 50 / record["wall_s"], delta=1)
        for key in ("date", "num_cpus", "caches", "git_commit", "git_dirty", "compiler",
                    "compiler_flags", "affinity", "denormals_flushed"):
            self.assertIn(key, record["context"])

    def test_overrides_may_be_expressions_and_may_name_a_part_of_a_vector_that_the_scene_leaves_out(
            self):
        for changes, elements in (
            (["n=2*6"], 144),
            (["n==2*6"], 144),
            (["n=12", "gravity.2=-9.81/2"], 144),
        ):
            sets = [word for change in changes for word in ("--set", change)]
            record = json.loads(
                dssbench("run", "plate_paper", *sets, "--steps", "5", "--json", "-").stdout)
            self.assertEqual(record["elements"], elements)

    def test_adaptive_steps_are_counted_and_end_where_the_steps_would(self):
        adaptive = ("--integrator", "dopri5", "--rtol")
        coarse, fine = self.run_json(*adaptive, "1e-4"), self.run_json(*adaptive, "1e-8")
        for record in (coarse, fine):
            self.assertEqual((record["status"], record["end_s"]), ("ok", 50 * record["dt_s"]))
            self.assertEqual(record["evaluations"],
                             7 * (record["steps"] + record["rejected_steps"]))
            self.assertLess(record["least_step_s"], record["largest_step_s"])
        self.assertLess(coarse["steps"], fine["steps"])
        self.assertEqual(
            self.run_json(*adaptive, "1e-8", "--threads", "2", "--warmup", "5")["state_digest"],
            fine["state_digest"])
        fixed = self.run_json("--integrator", "dopri5", "--dt", "2.5e-7", steps=200)
        self.assertEqual((fixed["rtol"], fixed["rejected_steps"], fixed["evaluations"]),
                         (None, None, 1200))
        displacement = fixed["max_displacement_m"]
        self.assertAlmostEqual(fine["max_displacement_m"], displacement, delta=1e-5 * displacement)

    def test_threads_without_rows_are_told_from_those_that_compute(self):
        for scene, workers in (("chain", 1), ("plate_paper", 2)):
            result = dssbench("run", scene, "--steps", "20", "--threads", "2", "--json", "-")
            record = json.loads(result.stdout)
            self.assertEqual((record["threads"], record["workers"]), (2, workers))

    def test_the_digest_is_that_of_the_state_and_of_nothing_else(self):
        digest = self.run_json()["state_digest"]
        self.assertEqual(self.run_json("--warmup", "7")["state_digest"], digest)
        self.assertNotEqual(self.run_json(steps=51)["state_digest"], digest)

    def test_a_run_in_batches_is_one_run(self):
        whole = self.run_json(steps=600)
        pieces = self.run_json("--output", self.path("a.vtu"), "--frames", "7", steps=600)
        self.assertEqual(whole["state_digest"], pieces["state_digest"])

    def test_leapfrogs_in_batches_are_one_run(self):
        for method in ("velocity_verlet", "smoothed_verlet"):
            options = ("--integrator", method)
            whole = self.run_json(*options, steps=600)
            pieces = self.run_json(*options, "--output", self.path("a.vtu"), "--frames", "7",
                                   steps=600)
            self.assertEqual(whole["state_digest"], pieces["state_digest"], method)

    def test_state_has_a_row_an_element_and_full_digits(self):
        record = self.run_json("--state", self.path("s.csv"))
        with open(self.path("s.csv"), encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([int(row["element"]) for row in rows], list(range(144)))
        largest = max(
            (float(row["ux"])**2 + float(row["uy"])**2 + float(row["uz"])**2)**0.5 for row in rows)
        self.assertAlmostEqual(largest / record["max_displacement_m"], 1, delta=1e-14)
        self.assertGreater(max(float(row["stress_vm"]) for row in rows), 0)
        self.assertEqual(os.listdir(self.directory), ["s.csv"])

    def test_a_series_has_its_frames_and_an_index(self):
        self.run_json("--output", self.path("p.vtu"), "--frames", "2")
        self.assertEqual(sorted(os.listdir(self.directory)),
                         ["p.pvd", "p_0000.vtu", "p_0001.vtu", "p_0002.vtu"])
        for step, name in ((0, "p_0000"), (25, "p_0001"), (50, "p_0002")):
            self.assertIn(f'timestep="{step * 1e-6:.17g}" part="0" file="{name}.vtu"',
                          self.read("p.pvd"))

    def test_a_series_in_one_file_is_whole_or_not_there(self):
        self.run_json("--output", self.path("p.vtkhdf"), "--frames", "2")
        self.assertEqual(os.listdir(self.directory), ["p.vtkhdf"])
        with open(self.path("p.vtkhdf"), "rb") as file:
            before = file.read()
        self.assertEqual(before[:8], b"\x89HDF\r\n\x1a\n")
        failing = dssbench("run", "plate_paper", "--set", "n=12", "--steps", "2000", "--dt", "1",
                           "--force", "--frames", "4", "--output", self.path("p.vtkhdf"))
        self.assertEqual(failing.returncode, 3, failing.stderr)
        self.assertEqual(os.listdir(self.directory), ["p.vtkhdf"])
        with open(self.path("p.vtkhdf"), "rb") as file:
            self.assertEqual(file.read(), before)
        self.assert_refused(2, ["a checkpoint cannot go on"], "run", "plate_paper", "--output",
                            self.path("p.vtkhdf"), "--checkpoint", self.path("c.ckpt"))
        self.assert_refused(2, ["ends in .vtu or .vtkhdf"], "run", "plate_paper", "--output",
                            self.path("p.vtk"))

    def test_the_vtu_has_the_displacements_of_the_state(self):
        sys.path.insert(0, str(ROOT / "plots"))
        try:
            from body_picture import read_vtu
        except ImportError as missing:
            self.skipTest(f"this python has no {missing.name}")
        self.run_json("--output", self.path("p.vtu"), "--state", self.path("s.csv"))
        arrays = read_vtu(self.path("p.vtu"))
        with open(self.path("s.csv"), encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        for cell, row in enumerate(rows):
            self.assertEqual([float(row[c]) for c in ("ux", "uy", "uz")],
                             list(arrays["CellData", "displacement"][cell]))
            self.assertEqual(float(row["stress_vm"]), arrays["CellData", "von_mises"][cell])
        # xy, yz, xz, as VTK orders them; the plate stays in its plane
        shear = arrays["CellData", "stress"][:, 3:]
        self.assertGreater(abs(shear[:, 0]).max(), 0)
        self.assertEqual(abs(shear[:, 1:]).max(), 0)
        corners = arrays["Cells", "connectivity"].reshape(-1, 8)
        middle = arrays["Points", "points"][corners].mean(axis=1)
        self.assertAlmostEqual(middle[143][0], float(rows[143]["x"]), delta=1e-12)
        self.assertEqual(len(arrays["Points", "points"]), 2 * 13 * 13)
        self.assertEqual(len(set(corners.ravel().tolist())), 2 * 13 * 13)

    def test_a_picture_comes_of_a_vtu(self):
        self.run_json("--output", self.path("p.vtu"))
        result = subprocess.run(
            [
                sys.executable,
                ROOT / "plots/body_picture.py", self.path("p.vtu"), "--output", self.path("p.png"),
            ],
            capture_output=True,
            text=True,
        )
        if "ModuleNotFoundError" in result.stderr:
            self.skipTest("this python has no matplotlib")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertGreater(os.path.getsize(self.path("p.png")), 5000)

    def test_pictures_come_of_a_series_and_of_a_body_with_depth(self):
        result = dssbench("run", "l_bracket", "--steps", "20", "--output", self.path("b.vtu"),
                          "--frames", "2")
        self.assertEqual(result.returncode, 0, result.stderr)
        result = subprocess.run(
            [
                sys.executable,
                ROOT / "plots/body_picture.py", self.path("b.pvd"), "--output", self.path("b.png"),
            ],
            capture_output=True,
            text=True,
        )
        if "ModuleNotFoundError" in result.stderr:
            self.skipTest("this python has no matplotlib")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout.split(), [self.path("b.png"), self.path("b_frames.png")])
        for name in ("b.png", "b_frames.png"):
            self.assertGreater(os.path.getsize(self.path(name)), 5000)

    def test_verify_writes_its_table_and_passes(self):
        result = dssbench("verify", "two_elements", "--variant", "reference,scalar", "--json",
                          self.path("v.json"))
        self.assertEqual(result.returncode, 0, result.stdout)
        rows = json.loads(self.read("v.json"))["rows"]
        self.assertEqual({row["variant"]
                          for row in rows
                          if row["verdict"] == "passed"}, {"reference", "scalar"})
        self.assertGreater(sum(row["error"] is not None for row in rows), 10)

    def test_lists_are_tables_or_json(self):
        for what in ("variants", "scenes", "experiments", "methods", "kernels", "devices"):
            self.assertEqual(dssbench("list", what).returncode, 0)
            self.assertGreater(len(json.loads(dssbench("list", what, "--json").stdout)), 0)

    def test_the_predicted_limit_is_between_half_and_twice_where_a_run_blows_up(self):
        text = dssbench("stability", "plate_paper", "--set", "n=10").stdout
        limit = float(text.split("dt = ")[1].split(" s")[0])
        stable = dssbench("run", "plate_paper", "--set", "n=10", "--steps", "3000", "--dt",
                          0.99 * limit)
        unstable = dssbench("run", "plate_paper", "--set", "n=10", "--steps", "3000", "--dt",
                            1.5 * limit, "--force")
        self.assertEqual((stable.returncode, unstable.returncode), (0, 3))

    def test_limits_of_every_method_are_predicted_measured_and_alike(self):
        result = dssbench("stability", "chain", "--set", "n=6", "--integrator", "all", "--json",
                          "-")
        limits = json.loads(result.stdout)["limits"]
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertLessEqual({"rk4", "velocity_verlet"}, {limit["integrator"] for limit in limits})
        for limit in limits:
            self.assertTrue(limit["is_exact"], limit)
            self.assertEqual(limit["status"], "ok", limit)
            self.assertAlmostEqual(limit["ratio"], 1, delta=0.01)
            self.assertIn(" of element ", limit["mode"])

    def test_a_limit_that_is_only_predicted_runs_nothing(self):
        limit = json.loads(dssbench("stability", "plate_paper", "--predict", "--json",
                                    "-").stdout)["limits"][0]
        self.assertEqual(
            (limit["runs"], limit["measured_dt_s"], limit["status"], limit["is_exact"]),
            (0, None, "not measured", False))


if __name__ == "__main__":
    unittest.main()
