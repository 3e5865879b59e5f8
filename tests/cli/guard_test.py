"""A guarded run: what it says, what it finds, and what is refused."""
import os
import unittest

from program import ProgramTest, dssbench, record, why_no_variant

PLATE = ("plate_paper", "--set", "n=12", "--variant", "avx2", "--steps", "60")


def flipped(flip):
    """Environment of a run with a wrong bit."""
    return {**os.environ, "DSSBENCH_FLIP": flip}


@unittest.skipIf(why_no_variant("avx2"), why_no_variant("avx2") or "")
class Guard(ProgramTest):
    def test_a_sound_run_has_the_same_bits_and_says_what_was_checked(self):
        plain = record("run", *PLATE)
        self.assertIsNone(plain["guard"])
        for steps, checks in ((1, 6), (4, 6), (10, 6)):
            guarded = record("run", *PLATE, "--guard", "10", "--guard-steps", steps)
            self.assertEqual(guarded["state_digest"], plain["state_digest"])
            guard = guarded["guard"]
            self.assertEqual((guard["checks"], guard["checked_steps"]), (checks, checks * steps))
            self.assertEqual((guard["every"], guard["steps"]), (10, steps))
            if not (why_no_variant("avx512") and why_no_variant("scalar-native")):
                self.assertNotEqual(guard["witness"], "avx2")
            self.assertGreater(guard["time_s"], 0)
        text = dssbench("run", *PLATE, "--guard", "10").stdout
        self.assertIn("6 of 60 steps computed again", text)

    def test_the_last_interval_may_be_short(self):
        guard = record("run", *PLATE, "--guard", "25", "--guard-steps", "25")["guard"]
        self.assertEqual((guard["checks"], guard["checked_steps"]), (3, 60))

    def test_a_bit_that_flips_once_is_found_where_all_steps_are_computed_twice(self):
        for step in (7, 10, 59):
            result = dssbench("run", *PLATE, "--guard", "10", "--guard-steps", "10", "--json",
                              self.path("r.json"), env=flipped(f"{step}:130:3:30"))
            self.assertEqual(result.returncode, 1, result.stdout)
            begin = step // 10 * 10
            self.assertIn(f"between steps {begin} and {begin + 10}, ", result.stderr)
            self.assertIn(f"a checkpoint of step {begin} or before", result.stderr)
            self.assertEqual(result.stdout, "")
            self.assertIn('"status": "faulty"', self.read("r.json"))

    def test_a_bit_that_makes_the_run_fail_is_told_from_an_unstable_run(self):
        exploded = ("--guard", "10", "--guard-steps", "10")
        result = dssbench("run", *PLATE, *exploded, env=flipped("23:130:3:62"))
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("a processor or memory may be faulty", result.stderr)
        unstable = dssbench("run", *PLATE[:-1], "3000", *exploded, "--dt", "1e-5", "--force",
                            "--model", "spatial")
        self.assertEqual(unstable.returncode, 3, unstable.stderr)

    def test_a_bit_that_stays_wrong_is_found_in_one_step(self):
        result = dssbench("run", *PLATE, "--guard", "10", env=flipped("23:130:3:54:stays"))
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, r"between steps (?P<ten>\d)0 and (?P=ten)1, ")
        missed = dssbench("run", *PLATE, "--guard", "10", "--no-balance",
                          env=flipped("23:130:3:30"))
        self.assertEqual(missed.returncode, 0, missed.stderr)

    def test_every_method_and_precision_can_be_guarded(self):
        for method in ("rk4", "velocity_verlet", "smoothed_verlet", "midpoint", "dopri5"):
            for precision in ("f64", "f32", "f32c"):
                with self.subTest(method=method, precision=precision):
                    guard = record("run", *PLATE, "--integrator", method, "--precision", precision,
                                   "--model", "spatial", "--dt", "1e-7", "--guard", "7",
                                   "--guard-steps", "3")["guard"]
                    self.assertEqual(guard["checks"], 9)

    def test_models_that_are_watched_and_promoted(self):
        block = ("block", "--set", "nx=7", "--set", "ny=5", "--set", "nz=4", "--steps", "58",
                 "--integrator", "rkc2", "--precision", "f32", "--variant", "avx2",
                 "--guard", "22", "--guard-steps", "22")
        whole = record("run", *block)
        promotion = whole["model_choice"]["promotions"][0]
        self.assertLess(promotion["resumed_step"], 22)
        # Steps that the promotion takes back count, too.
        self.assertEqual(whole["guard"]["checked_steps"],
                         58 + promotion["step"] - promotion["resumed_step"])
        for step in (promotion["resumed_step"] - 3, promotion["resumed_step"] + 3):
            result = dssbench("run", *block, env=flipped(f"{step}:81:0:1"))
            self.assertEqual(result.returncode, 1, result.stdout)
            self.assertIn("a processor or memory may be faulty", result.stderr)

    @unittest.skipIf(why_no_variant("mpi"), why_no_variant("mpi") or "")
    def test_ranks_have_a_witness_on_ranks(self):
        ranks = (*PLATE, "--ranks", "2", "--halo", "deep", "--guard", "20")
        self.assertEqual(record("run", *ranks)["guard"]["checks"], 3)
        result = dssbench("run", *ranks, "--guard-steps", "20", env=flipped("25:130:3:30"))
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        self.assertIn("between steps 20 and 40", result.stderr)

    def test_devices_and_hybrids_have_a_witness_on_the_processor(self):
        for options, variant in ((("--hybrid", "scalar-native:1,avx2:1"), "scalar-native"),
                                 (("--variant", "opencl"), "opencl")):
            if why_no_variant(variant):
                continue
            run = [option for option in PLATE if option not in ("--variant", "avx2")]
            self.assertEqual(record("run", *run, *options, "--guard", "30")["guard"]["checks"], 2)

    def test_what_cannot_be_guarded_is_refused(self):
        for words, options in (
                (["--guard -1", "1 step"], ["--guard", "-1"]),
                (["--guard-steps 11", "1 to 10"], ["--guard", "10", "--guard-steps", "11"]),
                (["--guard-steps 0"], ["--guard", "10", "--guard-steps", "0"]),
                (["--guard", "1 step"], ["--guard-steps", "2"]),
                (["--guard", "1 step"], ["--guard", "0"]),
                (["--guard-variant", "opencl-rhs"], ["--guard", "10", "--guard-variant",
                                                  "opencl-rhs"]),
                (["--rtol"], ["--guard", "10", "--integrator", "dopri5", "--rtol", "1e-6"]),
                (["--samples"], ["--guard", "10", "--samples", "2"]),
                (["scalar", "does not fuse"], ["--guard", "10", "--guard-variant", "scalar"]),
                (["avx3", "avx2"], ["--guard", "10", "--guard-variant", "avx3"]),
                (["--ensemble"], ["--guard", "10", "--ensemble", "8"])):
            with self.subTest(options=options):
                self.assert_refused(2, words, "run", *PLATE, *options)
        run = [option for option in PLATE if option not in ("--variant", "avx2")]
        self.assert_refused(2, ["reference", "--variant"], "run", *run, "--variant", "reference",
                            "--guard", "10")
        for flip in ("1:2:3", "1:2:3:4:goes", "1:2:99:4", "x"):
            result = dssbench("run", *PLATE, env=flipped(flip))
            self.assertEqual(result.returncode, 2, flip)
            self.assertIn("DSSBENCH_FLIP", result.stderr)


if __name__ == "__main__":
    unittest.main()
