"""The methods `chebyshev` and `faber` by the command line."""
import json
import re
import unittest

from program import ProgramTest, dssbench, shipped_scene

PLATE = ("run", "plate_paper", "--set", "n=10", "--model", "membrane")


class Exponential(ProgramTest):
    def chain(self):
        """A run of a bar without damping."""
        scene = shipped_scene("chain")
        scene["bodies"][0]["constants"]["damping_ratio"] = 0
        return ("run", self.write("bar.json", json.dumps(scene)), "--set", "n=40", "--model",
                "axial", "--dt", "2.5e-6")

    def record(self, *arguments):
        result = dssbench(*arguments, "--json", "-")
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def test_faber_has_the_same_result_in_few_long_and_many_short_steps(self):
        ends = [self.record(*PLATE, "--integrator", "faber", "--dt", f"{0.0004 / steps:.17g}",
                            "--steps", str(steps)) for steps in (4, 20, 200)]
        for record in ends:
            self.assertEqual(record["status"], "ok")
            self.assertAlmostEqual(
                record["max_displacement_m"] / ends[0]["max_displacement_m"], 1, delta=1e-10)
        self.assertLess(ends[0]["evaluations"], ends[1]["evaluations"])
        # classical steps, of which the shortest errs by some 1e-9
        other = self.record(*PLATE, "--integrator", "verner8", "--dt", "2e-7", "--steps", "2000")
        self.assertAlmostEqual(
            ends[0]["max_displacement_m"] / other["max_displacement_m"], 1, delta=1e-8)

    def test_chebyshev_takes_leaps_that_end_where_the_run_pauses(self):
        run = (*self.chain(), "--integrator", "chebyshev", "--steps", "3600")
        whole = self.record(*run)
        self.assertIn("leaps of ", whole["schedule"])
        self.assertLess(whole["evaluations"], 3600)
        self.assertEqual(whole["status"], "ok")
        paused = self.record(*run, "--output", self.path("f.vtu"), "--frames", "3")
        self.assertAlmostEqual(
            paused["max_displacement_m"] / whole["max_displacement_m"], 1, delta=1e-10)
        again = self.record(*run, "--samples", "2")
        self.assertEqual(again["state_digest"], whole["state_digest"])
        faber = self.record(*self.chain()[:-2], "--integrator", "faber", "--dt", "5e-5", "--steps",
                            "180")
        self.assertAlmostEqual(
            faber["max_displacement_m"] / whole["max_displacement_m"], 1, delta=1e-9)

    def test_ranks_have_them(self):
        scene = shipped_scene("plate_paper")
        scene["bodies"][0]["constants"] |= {"d": 0, "dt": 0}
        undamped = ("run", self.write("plate.json", json.dumps(scene)), *PLATE[2:])
        for method, plate in (("faber", PLATE), ("chebyshev", undamped)):
            run = (*plate, "--integrator", method, "--steps", "50", "--variant", "avx2")
            self.assertEqual(self.record(*run, "--ranks", "2")["state_digest"],
                             self.record(*run)["state_digest"])

    def test_what_they_do_not_compute_is_refused_in_a_line_that_says_what_would_do(self):
        for method in ("chebyshev", "faber"):
            self.assert_refused(2, [method, "linear models", "--model membrane"], "run",
                                "plate_paper", "--set", "n=10", "--integrator", method,
                                "--model", "spatial")
        chebyshev = (*self.chain(), "--integrator", "chebyshev")
        self.assert_refused(2, ["damping", "faber"], *PLATE, "--integrator", "chebyshev")
        kinked = dssbench(*chebyshev[:-3], "3e-6", *chebyshev[-2:])
        self.assertEqual(kinked.returncode, 2)
        self.assertIn("kink at 0.0001 s", kinked.stderr)
        asked = re.search(r"give --dt ([^,]*),", kinked.stderr).group(1)
        self.record(*chebyshev[:-3], asked, *chebyshev[-2:])
        self.assert_refused(2, ["f64 and f32 alone"], *chebyshev, "--precision", "f32c")
        self.assert_refused(2, ["reference"], *chebyshev, "--variant", "reference")
        self.assert_refused(2, ["--checkpoint", "leaps"], *chebyshev, "--checkpoint",
                            self.path("c"))
        self.assert_refused(2, ["--guard", "leaps"], *chebyshev, "--guard", "10")
        self.assert_refused(2, ["--rtol", "faber"], *PLATE, "--integrator", "faber", "--rtol",
                            "1e-6")
        self.assert_refused(2, ["stages of faber", "give --dt"], *PLATE, "--integrator", "faber",
                            "--dt", "1")
        self.assert_refused(2, ["rotations tait_bryan"], *PLATE, "--integrator", "faber",
                            "--variant", "reference", "--rotation", "tait_bryan")
        self.assert_refused(2, ["faber", "runs alone"], "simulate", "plate_paper", "--ranks", "2",
                            "--integrator", "faber")
        slow = self.write("hum.json", json.dumps(self.scene_with_hum(2e5)))
        self.assert_refused(2, ["too long for a signal of 200000 Hz", "give --dt 2.4e-07"], "run",
                            slow, *PLATE[2:], "--integrator", "faber")

    def scene_with_hum(self, frequency):
        scene = shipped_scene("plate_paper")
        scene["loads"][0]["signal"] = {"harmonic": {"amplitude": 1, "frequency": frequency}}
        return scene


if __name__ == "__main__":
    unittest.main()
