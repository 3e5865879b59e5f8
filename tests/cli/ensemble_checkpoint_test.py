"""Saved ensembles go on with other lanes, threads and ranks; each member has its bits."""
import json
import os
import pathlib
import signal
import unittest

from program import dssbench, why_no_variant
from runs import RunTest, members_of

# Five members of a bracket, of two lengths; the last one has another step.
SETS = [{}, {"loads/0/force/2": -300}, {"run.steps": 200}, {"bodies/0/constants/rho": 1800},
        {"run.dt": 1e-7}]
BRACKET = ("l_bracket", "--model", "spatial", "--set", "run.steps=240")


def digests(record):
    return [member["state_digest"] for member in members_of(record)]


class SavedEnsembles(RunTest):
    def setUp(self):
        super().setUp()
        self.of = (*BRACKET, "--ensemble", self.members(*SETS))

    def save(self, *arguments, every=220, code=0):
        return super().save(*arguments, every=every, code=code)

    def test_members_go_on_elsewhere_with_the_bits_of_the_whole(self):
        here = [name for name in ("avx2", "avx512") if why_no_variant(name) is None]
        places = [("--threads", "2")] + [("--variant", name) for name in here]
        if why_no_variant("mpi") is None:
            places += [("--ranks", "2")]
            places += [("--variant", name, "--ranks", "3") for name in here[:1]]
        for method, precision in (("rk4", "f64"), ("velocity_verlet", "f32"),
                                  ("smoothed_verlet", "f32c")):
            run = (*self.of, "--integrator", method, "--precision", precision)
            whole = self.save(*run)
            standing = self.head("c.ckpt.previous")["standing"]
            self.assertEqual({(own["step"], own["is_done"]) for own in standing},
                             {(200, True), (220, False)})
            for place in places:
                again = self.run_json(*run, *place, "--restart", "c.ckpt.previous")
                self.assertEqual(digests(again), digests(whole), (method, place))
                self.assertEqual(again["resumed_step"], 220)

    def test_lanes_and_single_members_go_on_for_one_another(self):
        if why_no_variant("opencl") is not None:
            self.skipTest("no opencl")
        run = ("two_elements", "--model", "spatial", "--steps", "60",
               "--ensemble", self.members({}, {"k": 900}, {"k": 1100}))
        whole = self.save(*run, every=25)
        again = self.run_json(*run, "--variant", "opencl", "--restart", "c.ckpt.previous")
        self.assertEqual(digests(again), digests(whole))
        self.save(*run, "--variant", "opencl", every=25)
        again = self.run_json(*run, "--restart", "c.ckpt.previous")
        self.assertEqual(digests(again), digests(whole))

    def test_a_member_that_failed_stays_failed(self):
        run = (*BRACKET, "--ensemble", self.members({}, {"run.dt": 2.5e-6}, {}),
               "--steps", "3000", "--force")
        whole = self.save(*run, every=1600, code=3)
        failed = members_of(whole)[1]["steps"]
        for every in (failed // 2, 2900):
            self.save(*run, every=every, code=3)
            ranks = [("--ranks", "2")] if why_no_variant("mpi") is None else []
            for place in ((), ("--threads", "2"), *ranks):
                again = self.run_json(*run, *place, "--restart", "c.ckpt.previous", code=3)
                for key in ("status", "reason", "steps", "state_digest"):
                    self.assertEqual([m[key] for m in members_of(again)],
                                     [m[key] for m in members_of(whole)], (every, key))

    def test_a_batch_that_is_done_keeps_its_members_and_its_failure(self):
        sets = [{"run.steps": 50} for _ in range(8)] + [{}]
        sets[2] = {"run.steps": 50, "run.dt": 1e-5}
        run = (*BRACKET, "--ensemble", self.members(*sets), "--force")
        whole = self.save(*run, every=60, code=3)
        again = self.save(*run, "--restart", "c.ckpt.previous", every=20, code=3)
        third = self.run_json(*run, "--restart", "c.ckpt.previous", code=3)
        for later in (again, third):
            self.assertGreaterEqual(later["element_steps_per_s"], 0)
            for key in ("status", "reason", "steps", "state_digest", "max_displacement_m"):
                self.assertEqual([m[key] for m in members_of(later)],
                                 [m[key] for m in members_of(whole)], key)
        self.assertEqual(len(set(digests(whole))), 3)
        # A checkpoint of a run that went on from one has what a longer run needs.
        sets = [{"run.steps": 300}] + sets[1:]
        longer = (*BRACKET, "--ensemble", self.members(*sets), "--force")
        self.assertEqual(digests(self.run_json(*longer, "--restart", "c.ckpt.previous", code=3)),
                         digests(self.run_json(*longer, code=3)))
        self.members(*({**own, "run.steps": 40} for own in sets[:8]), {})
        self.assert_refused(2, ["end at step 40", "at step 50"], "run", *run, "--restart",
                            self.path("c.ckpt.previous"))

    def test_a_longer_ensemble_goes_on_from_the_end(self):
        equal = (*BRACKET, "--ensemble", "5")
        self.save(*equal, "--steps", "300", every=200)
        longer = (*equal, "--steps", "1500")
        whole = self.run_json(*longer)
        again = self.run_json(*longer, "--restart", "c.ckpt")
        self.assertEqual(digests(again), digests(whole))
        computed = 5 * 152 * (1500 - 300)
        self.assertAlmostEqual(again["element_steps_per_s"] * again["wall_s"] / computed, 1)
        self.assertIsNotNone(members_of(again)[0]["energy_error"])
        self.assert_refused(2, ["300 steps", "--steps", "c.ckpt.previous"], "run", *equal,
                            "--steps", "300", "--restart", self.path("c.ckpt"))
        for steps in (160, 200):  # members that end there were saved there, or earlier
            sets = [{}, {}, {"run.steps": steps}]
            run = (*BRACKET, "--ensemble", self.members(*sets))
            self.save(*run, every=160)
            sets[2] = {"run.steps": 160}
            again = dssbench("run", *BRACKET, "--ensemble", self.members(*sets), "--restart",
                             self.path("c.ckpt.previous"))
            self.assertEqual(again.returncode, 0 if steps == 160 else 2, again.stderr)

    def test_frames_go_on(self):
        run = (*self.of, "--output", "f.vtu", "--frames", "5")
        self.run_json(*run)
        names = sorted(name for name in os.listdir(self.directory) if name.startswith("f"))
        whole = {name: self.read(name) for name in names}
        self.assertEqual(len(whole), 5 * 7)
        self.save(*run)
        for name in names:
            if name.endswith(("_0005.vtu", ".pvd")) and "f-3" not in name:
                os.remove(self.path(name))
        self.run_json(*run, "--restart", "c.ckpt.previous")
        self.assertEqual({name: self.read(name) for name in names}, whole)

    def test_foreign_and_damaged_ones_are_refused(self):
        self.save(*self.of)
        saved = self.path("c.ckpt.previous")
        self.run_json(*BRACKET, "--steps", "40", "--checkpoint", "one.ckpt")
        for words, other in ((["scene differs"], (*self.of, "--set", "loads/0/force/1=5")),
                             (["--precision"], (*self.of, "--precision", "f32")),
                             (["rounding"], (*self.of, "--variant", "scalar")),
                             (["cannot save"], (*self.of, "--variant", "reference")),
                             (["members", "5 there, 3 here"], (*BRACKET, "--ensemble", "3")),
                             (["give its --ensemble"], BRACKET),
                             (["--samples"], (*self.of, "--samples", "2"))):
            self.assert_refused(2, words, "run", *other, "--restart", saved)
        self.assert_refused(2, ["leave --ensemble out"], "run", *self.of, "--restart",
                            self.path("one.ckpt"))
        self.write("m.json", json.dumps({"members": [{"set": own} for own in SETS[::-1]]}))
        self.assert_refused(2, ["scene differs"], "run", *self.of, "--restart", saved)
        self.members(*SETS)
        content = pathlib.Path(saved).read_bytes()
        for damaged, word in ((content[:-1], "ends within"), (content[:9000], "earlier file"),
                              (content[:9000] + bytes([content[9000] ^ 1]) + content[9001:],
                               "damaged")):
            pathlib.Path(saved).write_bytes(damaged)
            self.assert_refused(2, [word, saved], "run", *self.of, "--restart", saved)

    def test_altered_heads_are_refused_or_change_no_bit(self):
        run = ("two_elements", "--model", "spatial", "--force", "--ensemble",
               self.members({"run.steps": 60}, {"run.steps": 20}, {"run.steps": 60, "run.dt": 9}))
        whole = self.save(*run, every=40, code=3)
        self.assertGreater(
            self.assert_altered_heads_are_harmless(whole, "c.ckpt.previous", *run, code=3), 20)

    def test_a_signal_saves_the_ensemble_and_says_how_to_go_on(self):
        run = (*BRACKET, "--ensemble", "9", "--steps")
        for number, options in ((signal.SIGINT, ()), (signal.SIGTERM, ("--threads", "2"))):
            line = self.interrupted(number, *run, "50000000", *options, "--checkpoint-every", "100")
            step = self.head("c.ckpt")["standing"][0]["step"]
            self.assertIn(f"after step {step};", line)
            limited = (*run, str(step + 50))
            again = self.run_json(*limited, "--restart", "c.ckpt")
            self.assertEqual(digests(again), digests(self.run_json(*limited)))
            for name in ("c.ckpt", "c.ckpt.previous"):
                if os.path.exists(self.path(name)):
                    os.remove(self.path(name))


if __name__ == "__main__":
    unittest.main()
