"""Saved runs go on elsewhere with the bits of an uninterrupted one; damaged or foreign ones do not.

tests/faults/restarts.py has random combinations.
"""
import json
import os
import pathlib
import re
import signal
import unittest

from program import dssbench, why_no_variant
from runs import RunTest

PLATE = ("plate_paper", "--set", "n=12", "--steps", "600", "--model", "spatial")
PAPER_LAW = {"law": "paper", "k": 1e6, "d": 1, "kt": 0, "dt": 1, "mass": 1, "inertia": 1}
LADDER = pathlib.Path(__file__).parents[2] / "experiments" / "scenes" / "ladder"
LONG = ("plate_paper", "--set", "n=40", "--steps", "50000000", "--model", "spatial")


class Checkpoints(RunTest):
    def save(self, *arguments, every=250):
        return super().save(*arguments, every=every)

    def test_two_are_kept_and_the_last_is_of_the_end(self):
        self.save(*PLATE)
        self.assertEqual(self.head("c.ckpt")["step"], 600)
        self.assertEqual(self.head("c.ckpt.previous")["step"], 500)
        self.assertEqual(sorted(os.listdir(self.directory)), ["c.ckpt", "c.ckpt.previous"])

    def test_continued_runs_have_the_bits_of_the_whole(self):
        methods = ("rk4", "velocity_verlet", "smoothed_verlet", "symplectic_euler", "dopri5",
                   "rkc2", "midpoint", "verner8")
        for number, method in enumerate(methods):
            precision = ("f64", "f32", "f32c")[number % 3]
            of_run = (*PLATE, "--integrator", method, "--precision", precision, "--dt", "4e-7")
            whole = self.save(*of_run, "--variant", "avx2")
            for place in (["--threads", "2"], ["--ranks", "2"], ["--variant", "opencl"],
                          ["--hybrid", "avx2:1,avx2:1"]):
                if any(why_no_variant(name) for name in ("mpi", "opencl", "hybrid")
                       if name in str(place) or (name == "mpi" and "--ranks" in place)):
                    continue
                again = self.run_json(*of_run, *place, "--restart", "c.ckpt.previous")
                self.assertEqual(again["state_digest"], whole["state_digest"], (method, place))
                self.assertEqual(again["resumed_step"], 500)

    def test_adaptive_steps_go_on_as_before(self):
        of_run = ("plate_paper", "--set", "n=12", "--steps", "2000", "--integrator", "dopri5",
                  "--rtol", "1e-6", "--model", "spatial")
        whole = self.save(*of_run, every=40)
        again = self.run_json(*of_run, "--threads", "2", "--restart", "c.ckpt.previous")
        for key in ("state_digest", "accepted_steps", "rejected_steps", "least_step_s"):
            self.assertEqual(again[key], whole[key], key)
        self.assertGreater(again["resumed_step"], 0)
        self.assert_refused(2, ["pauses", "--steps"], "run", *of_run[:3], "--steps", "2500",
                            *of_run[5:], "--restart", self.path("c.ckpt.previous"))

    def test_a_watched_model_and_its_promotions_go_on_as_before(self):
        of_run = (LADDER / "roll_up.json", "--set", "n=8")
        whole = self.save(*of_run, every=100000)
        choice = whole["model_choice"]
        end, promoted = self.head("c.ckpt")["step"], choice["promotions"][0]["step"]
        models = set()
        for place in (promoted // 3, promoted - 1, promoted + 1, (promoted + end) // 2):
            self.save(*of_run, every=max(place, end - place - 1))
            saved = "c.ckpt.previous"
            models.add(self.head(saved)["model"])
            again = self.run_json(*of_run, "--restart", saved)
            self.assertEqual(again["state_digest"], whole["state_digest"], place)
            self.assertEqual(again["model"], whole["model"])
            found = again["model_choice"]
            self.assertEqual(found["promotions"], choice["promotions"])
            for key in ("largest_rotation_rad", "estimate", "looks"):
                self.assertEqual(found["monitor"][key], choice["monitor"][key], (place, key))
        self.assertEqual(models, {"bending", "spatial"})

    def test_a_longer_run_goes_on_from_the_end(self):
        self.save(*PLATE)
        longer = ("plate_paper", "--set", "n=12", "--steps", "900", "--model", "spatial")
        whole = self.run_json(*longer)
        again = self.run_json(*longer, "--restart", "c.ckpt")
        self.assertEqual(again["state_digest"], whole["state_digest"])
        self.assertEqual(again["resumed_step"], 600)
        self.assert_refused(2, ["600 steps", "--steps", "c.ckpt.previous"], "run", *PLATE,
                            "--restart", self.path("c.ckpt"))

    def test_rates_are_of_the_steps_after_the_restart(self):
        of_run = ("plate_paper", "--set", "n=40", "--steps", "1200", "--model", "spatial")
        whole = self.save(*of_run, every=500)
        again = self.run_json(*of_run, "--restart", "c.ckpt.previous")
        computed = 1600 * (1200 - again["resumed_step"])
        self.assertEqual(again["resumed_step"], 1000)
        self.assertAlmostEqual(again["element_steps_per_s"] * again["wall_s"] / computed, 1)
        # The energy is followed from the first look on.
        self.assertIsNotNone(whole["energy_error"])
        self.assertIsNotNone(again["energy_error"])
        self.assertEqual(again["state_digest"], whole["state_digest"])

    def test_a_run_goes_on_from_the_earlier_one_and_saves_itself_again(self):
        whole = self.save(*PLATE)
        again = self.run_json(*PLATE, "--restart", "c.ckpt.previous", "--checkpoint", "c.ckpt")
        self.assertEqual(again["state_digest"], whole["state_digest"])
        self.assertEqual(self.head("c.ckpt")["step"], 600)

    def test_other_voxels_of_a_file_are_another_scene(self):
        scene = {"scene": "shape", "title": "a shape", "run": {"dt": 1e-7, "steps": 40},
                 "bodies": [{"name": "b", "element": 1, "constants": PAPER_LAW,
                             "geometry": {"voxels": {"file": "mask.txt"}}}]}
        path = self.write("shape.json", json.dumps(scene))
        self.write("mask.txt", "###.....\n#####...\n")
        self.save(path, every=20)
        self.write("mask.txt", "####....\n####....\n")
        self.assert_refused(2, ["scene differs"], "run", path, "--restart",
                            self.path("c.ckpt.previous"))

    def test_a_series_of_frames_goes_on(self):
        frames = ("--output", "f.vtu", "--frames", "6")
        self.run_json(*PLATE, *frames)
        names = sorted(name for name in os.listdir(self.directory) if name.startswith("f"))
        whole = {name: self.read(name) for name in names}
        self.save(*PLATE, *frames)
        for name in ("f_0006.vtu", "f.pvd"):
            os.remove(self.path(name))
        self.run_json(*PLATE, *frames, "--restart", "c.ckpt.previous")
        self.assertEqual({name: self.read(name) for name in names}, whole)
        os.remove(self.path("f_0002.vtu"))
        result = dssbench("run", *PLATE, *frames, "--restart", "c.ckpt.previous",
                          cwd=self.directory)
        self.assertEqual(result.returncode, 2)
        self.assertIn("f_0002.vtu", result.stderr)

    def test_foreign_and_damaged_ones_are_refused(self):
        self.save(*PLATE)
        saved = self.path("c.ckpt.previous")
        for words, other in ((["scene differs"], ("--set", "n=13")),
                             (["scene differs"], ("--set", "bodies.0.constants.mass=3")),
                             (["--precision"], ("--precision", "f32")),
                             (["--integrator"], ("--integrator", "midpoint")),
                             (["--dt"], ("--dt", "5e-7")),
                             (["rounding"], ("--variant", "scalar")),
                             (["cannot save"], ("--variant", "reference")),
                             (["--samples"], ("--samples", "2"))):
            self.assert_refused(2, words, "run", *PLATE, *other, "--restart", saved)
        content = pathlib.Path(saved).read_bytes()
        for damaged, word in ((content[:-1], "ends within"), (content[:2000], "earlier file"),
                              (b"x" + content[1:], "not a checkpoint"),
                              (content[:900] + bytes([content[900] ^ 1]) + content[901:],
                               "damaged")):
            pathlib.Path(saved).write_bytes(damaged)
            self.assert_refused(2, [word, saved], "run", *PLATE, "--restart", saved)
        self.assert_refused(2, ["No such file"], "run", *PLATE, "--restart", self.path("none"))

    def test_altered_heads_are_refused_or_change_no_bit(self):
        run = ("two_elements", "--steps", "60", "--integrator", "dopri5", "--rtol", "1e-6")
        whole = self.save(*run, every=5)
        self.assertGreater(
            self.assert_altered_heads_are_harmless(whole, "c.ckpt.previous", *run), 20)

    def test_bad_options_are_refused(self):
        for every in ("0", "-3", "s", "0s", "nans", "infs", "2m", "1.5", ""):
            self.assert_refused(2, ["--checkpoint-every"], "run", *PLATE, "--checkpoint",
                                self.path("c"), "--checkpoint-every", every)
        self.assert_refused(2, ["--checkpoint"], "run", *PLATE, "--checkpoint-every", "9")
        for option in ("--checkpoint", "--restart"):
            self.assert_refused(2, [option, "empty"], "run", *PLATE, option, "")
        self.assert_refused(2, ["--checkpoint", "--json"], "run", *PLATE, "--checkpoint",
                            self.path("c"), "--json", self.path("c.previous"))
        self.assert_refused(2, ["no/c"], "run", *PLATE, "--checkpoint", self.path("no/c"))
        self.assertEqual(os.listdir(self.directory), [])

    def test_a_signal_saves_the_run_and_says_how_to_go_on(self):
        ranks = [] if why_no_variant("mpi") else [["--ranks", "2"]]
        for number, options in zip((signal.SIGTERM, signal.SIGUSR1, signal.SIGINT),
                                   [[], ["--threads", "2"], *ranks]):
            line = self.interrupted(number, *LONG, "--checkpoint-every", "20", *options)
            step = self.head("c.ckpt")["step"]
            if not options:
                self.assertEqual(int(re.search(r"after step (\d+);", line).group(1)), step)
            limited = (*LONG[:3], "--steps", str(step + 50), *LONG[5:])
            again = self.run_json(*limited, "--restart", "c.ckpt")
            self.assertEqual(again["resumed_step"], step)
            self.assertEqual(again["state_digest"], self.run_json(*limited)["state_digest"])
            for name in os.listdir(self.directory):
                os.remove(self.path(name))

    def test_a_checkpoint_that_cannot_be_written_does_not_end_the_run(self):
        result = dssbench("run", *PLATE, "--checkpoint", "/dev/full", cwd=self.directory)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("No space left", result.stderr)
        self.assertIn("the run goes on", result.stderr)


if __name__ == "__main__":
    unittest.main()
