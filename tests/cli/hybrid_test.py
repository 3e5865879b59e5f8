"""Hybrids on the command line: members as text, refusals, results, and the same bits on ranks."""
import json
import os
import shutil
import unittest

from devices_test import NO_PLATFORM, SMALL, devices, why_no_variant
from program import ProgramTest, dssbench, record

PLATE = ("run", "plate_paper", "--set", "n=24", "--steps", "60")


HAS_CPU_DEVICE = any(device["kind"] == "cpu" for device in devices())


class Options(ProgramTest):
    def test_a_hybrid_names_its_devices_and_variants_itself(self):
        self.assert_refused(2, ["--hybrid", "--variant"], *SMALL, "--hybrid", "auto", "--variant",
                            "reference")
        self.assert_refused(2, ["--device cpu", "opencl@cpu"], *SMALL, "--hybrid", "auto",
                            "--device", "cpu")
        self.assert_refused(2, ["--hybrid auto", "--ranks"], *SMALL, "--hybrid", "auto", "--ranks",
                            "2")

    def test_a_member_that_cannot_run_here_is_named_before_anything_starts(self):
        for variant, ranks in (("hybrid", ()), ("mpi", ("--ranks", "2"))):
            if why_no_variant(variant):
                continue
            self.assert_refused(2, ["member nonsense", "does not exist"], *SMALL, "--hybrid",
                                "reference,nonsense", *ranks)
            self.assert_refused(2, ["member reference@gpu", "--variant opencl"], *SMALL, "--hybrid",
                                "reference@gpu", *ranks)


@unittest.skipIf(why_no_variant("hybrid"), why_no_variant("hybrid"))
class Members(ProgramTest):
    def test_text_that_is_no_list_of_members_is_refused_with_what_would_be_right(self):
        for text, word in (("auto:0", "number of threads"), ("auto:x", "number of threads"),
                           ("auto=-1", "not a weight"), ("auto=1,auto", "have a weight"),
                           ("auto,,auto", "no variant"), ("opencl@0:0", "in brackets"),
                           ("opencl@[0:0", "not closed"), ("opencl@", "no device"),
                           ("auto:1]", "number of threads")):
            with self.subTest(members=text):
                self.assert_refused(2, ["hybrid", word], *SMALL, "--hybrid", text)

    def test_members_that_have_parts_of_their_own_or_round_otherwise_are_refused(self):
        self.assert_refused(2, ["member", "hybrid has parts of its own"], *SMALL, "--hybrid",
                            "auto,hybrid")
        if not why_no_variant("avx2"):
            self.assert_refused(2, ["member", "rounds otherwise"], *SMALL, "--hybrid",
                                "avx2,reference")

    def test_the_result_says_what_each_member_did(self):
        single = record(*PLATE)
        hybrid = record(*PLATE, "--hybrid", "auto:1=3,auto:2=1")
        self.assertEqual((hybrid["variant"], hybrid["workers"], hybrid["ranks"]), ("hybrid", 3, 1))
        self.assertEqual(hybrid["state_digest"], single["state_digest"])
        self.assertIsNone(single["hybrid"])
        members = hybrid["hybrid"]["members"]
        # 60 steps are too few for a move
        self.assertEqual([member["share"] for member in members], [0.75, 0.25])
        for member, threads in zip(members, (1, 2)):
            self.assertEqual(member["member"], f"{single['variant']}:{threads}")
            self.assertGreater(member["element_steps_per_s"], 0)
            self.assertGreater(member["step_s"], 0)
        self.assertEqual((hybrid["hybrid"]["rebalances"], hybrid["hybrid"]["reason"]), (0, ""))

    def test_auto_takes_one_executor_on_a_small_plate_and_says_why(self):
        chosen = record(*PLATE, "--hybrid", "auto")["hybrid"]
        self.assertEqual(len(chosen["members"]), 1)
        self.assertIn("measured", chosen["reason"])

    def test_its_line_on_the_terminal_has_shares_and_speeds(self):
        result = dssbench(*SMALL, "--hybrid", "auto,auto")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(
            result.stdout,
            r"hybrid: \S+:1 50\.0 % of the elements, .* million element-steps/s; "
            r".*re-balanced 0 times"
        )


@unittest.skipIf(why_no_variant("hybrid") or why_no_variant("opencl"), "needs hybrid and opencl")
class MembersOnDevices(ProgramTest):
    def test_a_device_beside_the_processor_gives_the_bits_of_one_executor(self):
        for precision in ("f64", "f32"):
            one = record(*PLATE, "--precision", precision)
            for members in ("auto,opencl", "opencl:2=1,auto=1",
                            f"auto,opencl@[{devices()[0]['device']}]"):
                with self.subTest(members=members, precision=precision):
                    several = record(*PLATE, "--precision", precision, "--hybrid", members)
                    self.assertEqual(several["state_digest"], one["state_digest"])
                    self.assertGreater(several["device"]["compute_units"], 0)
                    self.assertGreater(several["launches"], 0)
                    self.assertEqual(
                        sum(member["member"].startswith("opencl")
                            for member in several["hybrid"]["members"]), 1)

    def test_an_unknown_device_of_a_member_is_told_with_the_known_ones(self):
        self.assert_refused(
            2,
            ["member opencl@no_such_device:1", "no such device", devices()[0]["device"]], *SMALL,
            "--hybrid", "auto,opencl@no_such_device",
        )

    def test_without_a_platform_its_member_is_refused_and_auto_computes_on_the_processor(self):
        self.assert_refused(2, ["member opencl:1", "no OpenCL platform"], *SMALL, "--hybrid",
                            "auto,opencl", **NO_PLATFORM)
        result = dssbench(*SMALL, "--hybrid", "auto", "--json", "-", **NO_PLATFORM)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(json.loads(result.stdout)["state_digest"], record(*SMALL)["state_digest"])


@unittest.skipIf(why_no_variant("mpi") or not shutil.which("mpirun"), "needs mpi")
class MembersOnRanks(ProgramTest):
    def test_ranks_take_members_in_turn_and_give_the_bits_of_one_process(self):
        one = record(*PLATE)
        members = [("auto:2=3,auto:1=1", {})]
        if not why_no_variant("avx2") and not why_no_variant("avx512"):
            members += [("avx512,avx2", {})]  # 8 and 4 elements in a pack
        if not why_no_variant("opencl") and HAS_CPU_DEVICE:
            # 16 in a pack; compiling takes longer
            members += [
                ("auto,opencl@cpu", {}),
                (
                    "auto,opencl@cpu",
                    {
                        "env": {
                            **os.environ,
                            "DSSBENCH_OPENCL_AS": "gpu",
                            "DSSBENCH_PATIENCE_S": "3",
                        }
                    },
                ),
            ]
        for text, options in members:
            for ranks in (2, 3):
                with self.subTest(members=text, ranks=ranks, as_gpu="env" in options):
                    several = record(*PLATE, "--hybrid", text, "--ranks", ranks, **options)
                    self.assertEqual((several["ranks"], several["halo"]), (ranks, "deep"))
                    self.assertEqual(several["halo_reason"],
                                     "members of a hybrid exchange once a step")
                    self.assertEqual(several["state_digest"], one["state_digest"])
        # datatypes over packs of other widths; elements of several ranks in one row
        if len(members) > 1:
            for option in (("--halo", "sendrecv"), ("--decomposition", "blocks")):
                with self.subTest(members=members[-1], option=option):
                    several = record(*PLATE, "--hybrid", members[-1][0], "--ranks", 3, *option,
                                     **members[-1][1])
                    self.assertEqual(several["state_digest"], one["state_digest"])
        weighted = record(*PLATE, "--hybrid", members[0][0], "--ranks", 2)
        self.assertAlmostEqual(weighted["imbalance"], 1.5)  # three quarters on one of two


if __name__ == "__main__":
    unittest.main()
