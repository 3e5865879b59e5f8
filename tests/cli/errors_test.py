"""Bad input: exit code 2 or 3, and one line that says what, where and what would be right."""
import json
import math
import os
import resource
import time
import unittest

from program import ProgramTest, dssbench, why_no_variant

SMALL = ("run", "plate_paper", "--set", "n=10", "--steps", "10")


def limit_files_to_one_block():
    resource.setrlimit(resource.RLIMIT_FSIZE, (512, 512))


def limit_memory():
    resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))


class Errors(ProgramTest):
    def test_an_unknown_command_suggests_the_nearest(self):
        self.assert_refused(2, ['did you mean "verify"'], "verfy")

    def test_an_unknown_option_suggests_the_nearest(self):
        self.assert_refused(2, ["--stepz", '"--steps"'], "run", "plate_paper", "--stepz", "3")

    def test_an_option_of_the_wrong_type_is_named(self):
        self.assert_refused(2, ["--steps", "many"], "run", "plate_paper", "--steps", "many")

    def test_an_unknown_scene_suggests_the_nearest(self):
        self.assert_refused(2, ["plate_papr", '"plate_paper"'], "run", "plate_papr")

    def test_a_missing_file_is_named(self):
        self.assert_refused(2, ["missing.json"], "run", self.path("missing.json"))

    def test_broken_json_is_told_with_its_line(self):
        self.assert_refused(2, ["broken.json", "line 2, column 10"], "run",
                            self.write("broken.json", '{\n"scene": }\n'))

    def test_an_unknown_variant_is_told_with_the_nearest(self):
        self.assert_refused(2, ["avx51", "avx512"], *SMALL, "--variant", "avx51")

    def test_run_and_verify_tell_an_unknown_variant_alike(self):
        for command in (SMALL, ("verify", "plate_paper")):
            self.assert_refused(2, ['variant "avx1024" does not exist', 'did you mean "avx2"'],
                                *command, "--variant", "avx1024")

    def test_all_keys_that_a_study_lacks_are_told_at_once(self):
        self.assert_refused(2, ['lacks the keys "title", "base", "scales"'], "experiment",
                            self.write("x.json", '{"experiment": "x", "cells": []}'))

    def test_more_threads_than_cores_are_told_in_a_run(self):
        with_all = dssbench(*SMALL, "--variant", "scalar", "--threads",
                            str(len(os.sched_getaffinity(0)) + 1))
        self.assertIn("threads share", with_all.stdout)
        self.assertNotIn("share", dssbench(*SMALL, "--variant", "scalar").stdout)

    def test_unknown_model_precision_and_integrator_are_told_with_the_nearest(self):
        self.assert_refused(2, ["plannar", "planar"], *SMALL, "--model", "plannar")
        self.assert_refused(2, ["f65", "f64"], *SMALL, "--precision", "f65")
        self.assert_refused(2, ["rk5", "rk4"], *SMALL, "--integrator", "rk5")

    def test_rotations_and_implicit_methods_are_refused_where_only_the_reference_has_them(self):
        self.assert_refused(2, ["tait_bryam", "tait_bryan"], *SMALL, "--rotation", "tait_bryam")
        for option in (("--rotation", "tait_bryan"), ("--integrator", "implicit_midpoint")):
            self.assert_refused(2, [*option, "scalar", "--variant reference"], *SMALL, "--variant",
                                "scalar", *option)
            self.assertEqual(dssbench(*SMALL, "--variant", "reference", *option).returncode, 0)

    def test_an_implicit_method_refuses_no_step_and_says_where_it_finds_no_state(self):
        implicit = ("run", "tumbling_box", "--variant", "reference", "--integrator",
                    "implicit_midpoint", "--steps", "4", "--dt")
        self.assertEqual(dssbench(*implicit, "1e-2").returncode, 0)
        self.assert_refused(
            3, ["finds no state", "step 1 ", "t = 0.5 s", "element", "--dt below 0.25 s"],
            *implicit, "0.5")

    def test_a_step_that_no_number_of_stages_makes_stable_is_refused_at_once(self):
        for dt in ("1e-3", "1"): # each mode is looked at up to such a step
            self.assert_refused(3, ["rkc2", "stability limit"], "run", "plate_paper", "--set",
                                "n=10", "--integrator", "rkc2", "--dt", dt)

    def test_adaptive_steps_are_refused_of_other_integrators_and_where_no_step_is_short_enough(
            self):
        self.assert_refused(2, ["--rtol", "rk4", "--integrator dopri5"], *SMALL, "--rtol", "1e-6")
        adaptive = (*SMALL, "--integrator", "dopri5")
        self.assert_refused(2, ["--atol", "only with --rtol"], *adaptive, "--atol", "1e-9")
        for option, value in (("--rtol", "0"), ("--rtol", "nan"), ("--atol", "-1")):
            self.assert_refused(2, [option], *adaptive,
                                "--rtol=1e-6" if option == "--atol" else "--force",
                                f"{option}={value}")
        self.assert_refused(2, ["--rtol 1e-07", "rounding of f32", "4.8e-07"], *adaptive,
                            "--precision", "f32", "--rtol", "1e-7")
        self.assert_refused(3, ["plate_paper", "t = ", "even a step of", "--rtol 1e-30"], *adaptive,
                            "--rtol", "1e-30", "--atol", "1e-30")

    def test_numbers_out_of_range_are_refused(self):
        for option, value in (("--threads", "0"), ("--threads", "-1"), ("--steps", "0"),
                              ("--dt", "0"), ("--dt", "nan"), ("--ranks", "0")):
            self.assert_refused(2, [option], "run", "plate_paper", "--set", "n=10",
                                f"{option}={value}")

    def test_errors_are_one_line_whatever_the_user_wrote(self):
        for text in ("a\nb", "\x1b[31mred", "tab\there", "long" * 1000):
            for command in (("run", text), ("run", "two_elements", "--set", f"d={text}"),
                            ("run", "two_elements", "--integrator", text), ("run", f"--{text}")):
                result = dssbench(*command)
                self.assertEqual(result.returncode, 2)
                self.assertEqual(result.stderr.count("\n"), 1, command)
                self.assertLess(len(result.stderr), 1500)
                self.assertNotIn("\x1b", result.stderr)

    def test_numbers_beyond_a_lifetime_are_refused(self):
        for option in ("--steps", "--warmup", "--samples"):
            for value in ("9223372036854775807", "9223372036854775808", "2000000000000000"):
                self.assert_refused(2, [option, "at most 1000000000000000"], *SMALL[:4], option,
                                    value)
        self.assert_refused(2, ["--frames", "at most"], *SMALL, "--output", self.path("f.vtu"),
                            "--frames", "2147483647")
        self.assert_refused(2, ["--frames"], *SMALL, "--output", self.path("f.vtu"), "--frames",
                            "2147483648")

    def test_scenes_that_do_not_fit_into_memory_are_refused_at_once(self):
        begin = time.monotonic()
        for scene in (("chain", "--set", "n=2147483647"), ("plate_paper", "--set", "n=46000")):
            self.assert_refused(2, [scene[0], "GB", "fewer elements"], "run", *scene,
                                preexec_fn=limit_memory)
        self.assertLess(time.monotonic() - begin, 10)

    def test_threads_on_a_variant_of_one_thread_are_refused(self):
        self.assert_refused(2, ["reference", "--threads 1"], *SMALL, "--variant", "reference",
                            "--threads", "2")

    def test_a_tile_is_refused_where_there_are_none_and_named_where_there_are(self):
        block = ("run", "block", "--steps", "3")
        self.assert_refused(2, ["--tile", "0"], *block, "--tile", "0")
        for more in (("--ranks", "2"), ("--hybrid", "auto"), ("--variant", "hybrid")):
            self.assert_refused(2, ["--tile 4", "parts"], *block, "--tile", "4", *more)
        self.assert_refused(2, ["--tile 4", "reference"], *block, "--tile", "4", "--variant",
                            "reference")
        self.assert_refused(2, ["--tile 4", "two_bodies", "extra links"], "run", "two_bodies",
                            "--tile", "4", "--variant", "scalar")
        self.assert_refused(2, ["--tile 4", "block", "stage by stage"], *block, "--tile", "4",
                            "--variant", "scalar", "--integrator", "dopri5", "--rtol", "1e-6")
        tiled = dssbench(*block, "--tile", "4", "--variant", "scalar", "--json", "-")
        whole = dssbench(*block, "--tile", "400", "--variant", "scalar", "--json", "-")
        self.assertIn("tiles of 4 rows", json.loads(tiled.stdout)["schedule"])
        self.assertNotIn("tiles", json.loads(whole.stdout)["schedule"])
        self.assertEqual(*(json.loads(run.stdout)["state_digest"] for run in (tiled, whole)))

    def test_the_planar_model_refuses_a_scene_that_leaves_the_plane_with_the_reason(self):
        self.assert_refused(2, ["plate_bending", "load 0", "--model spatial"], "run",
                            "plate_bending", "--set", "n=10", "--model", "planar")

    def test_a_variant_that_the_cpu_lacks_is_refused_and_skipped_by_verify(self):
        hidden = {"env": {**os.environ, "DSSBENCH_HIDE_CPU_FEATURES": "fma,avx512f"}}
        for variant, feature in (("avx2", "fma"), ("avx512", "avx512f")):
            if "left out" in (why_no_variant(variant) or ""):
                continue
            self.assert_refused(2, [variant, f"lacks {feature}", "list variants"], *SMALL,
                                "--variant", variant, **hidden)
        result = dssbench("verify", "two_elements", "--variant", "scalar,avx2", **hidden)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("this CPU lacks fma", result.stdout)

    def test_stacks_that_no_thread_can_have_are_refused(self):
        run = ("run", "two_elements", "--steps", "5", "--threads", "2")
        for name, size in (("OMP_STACKSIZE", " 1000000 G"), ("GOMP_STACKSIZE", "2000000g ")):
            result = dssbench(*run, env={**os.environ, name: size})
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
            for word in (f"{name}={size}:", "unset it"):
                self.assertIn(word, result.stderr)
        for size in ("2m", "4096", "1 G", "1000000Gx", "many"):  # libgomp ignores the last two
            result = dssbench(*run, env={**os.environ, "OMP_STACKSIZE": size})
            self.assertEqual(result.returncode, 0, result.stderr)

    def test_a_team_smaller_than_asked_for_is_refused_instead_of_leaving_rows_behind(self):
        limited = {"env": {**os.environ, "OMP_THREAD_LIMIT": "1"}}
        self.assert_refused(2, ["--threads 3", "OMP_THREAD_LIMIT"], *SMALL, "--variant", "scalar",
                            "--threads", "3", **limited)

    def test_an_override_without_a_value_is_refused(self):
        self.assert_refused(2, ["KEY=VALUE"], "run", "plate_paper", "--set", "n")

    def test_a_negative_size_is_refused(self):
        self.assert_refused(2, ["/geometry/box"], "run", "plate_paper", "--set", "n=-3")

    def test_a_step_above_the_stability_limit_is_refused_with_both_numbers(self):
        self.assert_refused(3, ["1e-05", "limit 2.9", "--force"], "run", "plate_paper", "--set",
                            "n=20", "--dt", "1e-5")

    def test_constants_that_leave_the_range_of_numbers_are_refused(self):
        for change, exit_code in (("k=1e308", 2), ("mass=1e-200", 3)):
            self.assert_refused(exit_code, ["stability limit"], "run", "plate_paper", "--set",
                                "n=10", "--set", "bodies.0.constants." + change)

    def test_an_unstable_run_claims_neither_speed_nor_state_beyond_its_end(self):
        result = dssbench("run", "plate_paper", "--set", "n=10", "--dt", "5e-6", "--force",
                          "--steps", "5000", "--json", "-")
        record = json.loads(result.stdout)
        self.assertEqual((result.returncode, record["status"], record["state_digest"],
                          record["max_displacement_m"]), (3, "unstable", None, None))
        self.assertLess(record["steps"], 100)

    def test_a_forced_unstable_run_stops_and_says_where(self):
        self.assert_refused(3, ["not finite after step", "element", "take --dt below 3.0"], "run",
                            "plate_paper", "--set", "n=10", "--dt", "5e-6", "--force", "--steps",
                            "5000")

    def test_every_variant_and_method_names_step_time_and_element_and_claims_no_state(self):
        # Ranks, devices and hybrids have tests of their own. Compiling for a device takes seconds.
        usable = [
            entry["variant"]
            for entry in json.loads(dssbench("list", "variants", "--json").stdout)
            if entry["status"] == "usable"
            and entry["variant"] not in ("mpi", "hybrid", "opencl", "opencl-rhs", "sparse")
        ]
        known = json.loads(
            dssbench("stability", "two_elements", "--predict", "--integrator", "all", "--json",
                     "-").stdout)
        for variant in usable:
            for method in known["limits"]:
                result = dssbench("run", "plate_paper", "--set", "n=5", "--dt", "1e-4", "--force",
                                  "--steps", "2000", "--variant", variant, "--integrator",
                                  method["integrator"], "--json", "-")
                record, where = json.loads(result.stdout), f"{variant} {method['integrator']}"
                self.assertEqual((result.returncode, record["status"], record["state_digest"],
                                  record["energy_j"]), (3, "unstable", None, None), where)
                self.assertRegex(
                    result.stderr,
                    r"not finite after step \d+ \(t = [0-9.e+-]+ s\), element \d+; take --dt below",
                    where)
                # A run that ends in that step, or one step before it, has not gone well either.
                for last in (record["steps"], record["steps"] - 1):
                    state = self.path("s.csv")
                    short = dssbench("run", "plate_paper", "--set", "n=5", "--dt", "1e-4",
                                     "--force", "--steps", last, "--variant", variant,
                                     "--integrator", method["integrator"], "--state", state)
                    if short.returncode == 0:
                        columns = [
                            row.split(",")[4:17] for row in self.read("s.csv").splitlines()[1:]
                        ]
                        self.assertFalse([
                            row for row in columns
                            for number in row if not math.isfinite(float(number))
                        ], where)
                    elif short.returncode == 1:
                        self.assertRegex(short.stderr, "the energy of .* J at the end is wrong")
                    else:
                        self.assertEqual(short.returncode, 3, short.stderr)
                        self.assertRegex(short.stderr, f"not finite after step {last} "
                                         "|beyond the range of numbers")

    def test_an_unstable_run_leaves_no_state_file(self):
        dssbench("run", "plate_paper", "--set", "n=10", "--dt", "5e-6", "--force", "--steps",
                 "5000", "--state", self.path("s.csv"))
        self.assertEqual(os.listdir(self.directory), [])

    def test_a_directory_that_does_not_exist_is_refused_before_computing(self):
        for option, name in (
            ("--state", "no/s.csv"),
            ("--output", "no/s.vtu"),
            ("--json", "no/s.json"),
        ):
            self.assert_refused(2, ["no/s.", "No such file or directory"], "run", "plate_paper",
                                "--steps", "1000000", option, self.path(name))

    def test_a_directory_without_write_permission_is_refused(self):
        # root may write everywhere, except where the kernel refuses
        target = "/proc/s.csv" if os.geteuid() == 0 else "/s.csv"
        self.assert_refused(2, [target, "cannot write"], *SMALL, "--state", target)

    def test_a_full_disk_is_one_line(self):
        self.assert_refused(2, ["No space left on device"], *SMALL, "--state", "/dev/full")

    def test_a_write_that_fails_midway_keeps_the_earlier_file_and_leaves_no_part(self):
        self.write("s.csv", "earlier")
        self.assert_refused(2, ["s.csv", "File too large"], *SMALL, "--state", self.path("s.csv"),
                            preexec_fn=limit_files_to_one_block)
        self.assertEqual(self.read("s.csv"), "earlier")
        self.assertEqual(os.listdir(self.directory), ["s.csv"])

    def test_a_check_against_a_state_of_another_size_is_refused(self):
        self.assert_refused(2, ["is no oracle state"], *SMALL, "--check-state",
                            self.write("x.state", "nonsense"))

    def test_verify_refuses_unknown_names_before_it_computes(self):
        self.assert_refused(2, ["plate_papr"], "verify", "plate_papr")
        self.assert_refused(2, ["avx3", '"avx2"'], "verify", "--variant", "avx3")

    def test_every_unknown_name_suggests_the_nearest(self):
        elements, statics = ("run", "two_elements"), ("run", "two_elements", "--analysis", "static")
        for arguments, nearest in (
            (("verfy",), "verify"),
            (("help", "verfy"), "verify"),
            (("list", "varients"), "variants"),
            (("completion", "bsh"), "bash"),
            (("--versoin",), "--version"),
            (("list", "variants", "--jsn"), "--json"),
            (("run", "two_elements", "--variant-pth", "x"), "--variant-path"),
            (("explain", "two_element"), "two_elements"),
            (("verify", "two_element"), "two_elements"),
            (("stability", "two_element"), "two_elements"),
            (("advise", "two_element", "--tolerance", "1"), "two_elements"),
            (("decompose", "two_element", "--parts", "2"), "two_elements"),
            (("simulate", "two_element", "--ranks", "2"), "two_elements"),
            (("experiment", "tabel1"), "table1"),
            (("experiment", "table1", "--scale", "smok"), "smoke"),
            (("verify", "--variant", "scaler"), "scalar"),
            (("stability", "two_elements", "--variant", "scaler"), "scalar"),
            (("advise", "two_elements", "--tolerance", "1", "--variant", "scaler"), "scalar"),
            (("advise", "two_elements", "--tolerance", "1", "--quantity", "disp"), "displacement"),
            (("advise", "two_elements", "--tolerance", "1", "--vary", "stretc"), "stretch"),
            ((*elements, "--variant", "scaler"), "scalar"),
            ((*elements, "--model", "spacial"), "spatial"),
            ((*elements, "--precision", "f65"), "f64"),
            ((*elements, "--integrator", "rk5"), "rk4"),
            ((*elements, "--rotation", "quaternin"), "quaternion"),
            ((*elements, "--halo", "depe"), "deep"),
            ((*elements, "--decomposition", "stripz"), "strips"),
            ((*elements, "--shares", "mesured"), "measured"),
            ((*elements, "--on-bound", "promot"), "promote"),
            ((*elements, "--analysis", "statik"), "static"),
            ((*statics, "--solver", "newtn"), "newton"),
            ((*statics, "--solver", "newtn", "--steps", "3"), "newton"),
            ((*statics, "--solver", "cg", "--preconditioner", "bloc"), "block_jacobi"),
            ((*statics, "--solver", "relaxation", "--masses", "scald"), "scaled"),
            ((*elements, "--set", "stretc=1"), "stretch"),
            ((*elements, "--set", "run.stps=1"), "steps"),
            (("decompose", "two_elements", "--parts", "2", "--method", "stripz"), "strips"),
            (("stability", "two_elements", "--integrator", "rk5"), "rk4"),
            (("simulate", "two_elements", "--ranks", "2", "--integrator", "rk5"), "rk4"),
            (("simulate", "two_elements", "--ranks", "2", "--halo", "ovrlap"), "overlap"),
            (
                ("simulate", "two_elements", "--ranks", "2", "--platform", "ten_gigabt"),
                "ten_gigabit",
            ),
            (
                (
                    "simulate", "two_elements", "--ranks", "2", "--decomposition", "stripz",
                    "--node-speed", "1e6"
                ),
                "strips",
            ),
            (("explain", "two_elements", "--precision", "f65"), "f64"),
        ):
            with self.subTest(arguments):
                self.assert_refused(2, [f'did you mean "{nearest}"?', "known: "], *arguments)

    def test_no_command_at_all_is_told_which_there_are(self):
        self.assert_refused(2, ["give a command", "verify", "--help"])

    def test_an_option_of_one_letter_that_is_none_is_told(self):
        self.assert_refused(2, ["-x: unknown option", "--set"], *SMALL, "-x")


if __name__ == "__main__":
    unittest.main()
