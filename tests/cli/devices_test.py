"""OpenCL devices on the command line: lists, choices, errors. Skipped without OpenCL."""
import json
import os
import unittest

from program import ProgramTest, dssbench, why_no_variant

SMALL = ("run", "plate_paper", "--set", "n=10", "--steps", "10")
NO_PLATFORM = {"env": {**os.environ, "OCL_ICD_VENDORS": "/nonexistent"}}


def devices():
    """All usable OpenCL devices."""
    listed = json.loads(dssbench("list", "devices", "--json").stdout)
    return [
        device for device in listed if device["status"] == "usable" and device["device"] != "host"
    ]


class Listing(ProgramTest):
    def test_it_has_the_host_first(self):
        result = dssbench("list", "devices", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        host = json.loads(result.stdout)[0]
        self.assertEqual((host["device"], host["kind"], host["status"]), ("host", "cpu", "usable"))

    def test_without_a_platform_it_says_so_in_a_row(self):
        for options in ((), ("--measure",)):
            result = dssbench("list", "devices", *options, **NO_PLATFORM)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("host", result.stdout)
            self.assertRegex(result.stdout,
                             "no OpenCL platform; install one: pocl-opencl-icd|built without")

    def test_only_devices_are_measured(self):
        self.assert_refused(2, ["--measure", "list devices"], "list", "scenes", "--measure")

    def test_measured_devices_have_bandwidth_and_arithmetic(self):
        if not devices():
            self.skipTest("no OpenCL device")
        result = dssbench("list", "devices", "--measure", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        for device in json.loads(result.stdout)[1:]:
            for key in ("triad_gb_per_s", "f32_gflop_per_s"):
                self.assertGreater(float(device[key]), 0.1, device)


class AskedFor(ProgramTest):
    def test_a_variant_of_the_cpu_has_no_device(self):
        self.assert_refused(2, ["--device cpu", "reference", "--variant opencl"], *SMALL,
                            "--variant", "reference", "--device", "cpu")
        self.assert_refused(2, ["--device cpu", "--variant opencl"], *SMALL, "--device", "cpu")
        self.assert_refused(2, ["--device cpu", "--variant opencl"], "verify", "two_elements",
                            "--variant", "reference", "--device", "cpu")


@unittest.skipIf(why_no_variant("opencl"), why_no_variant("opencl"))
class OnDevices(ProgramTest):
    def opencl(self, *arguments):
        return (*SMALL, "--variant", "opencl", *arguments)

    def cache(self, path):
        return {"env": {**os.environ, "DSSBENCH_CACHE_DIR": path}}

    def test_without_a_platform_the_variant_is_refused_and_listed_as_unusable(self):
        self.assert_refused(2, ["variant opencl", "no OpenCL platform", "pocl-opencl-icd"],
                            *self.opencl(), **NO_PLATFORM)
        result = dssbench("list", "variants", **NO_PLATFORM)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stdout, "opencl .*unusable: no OpenCL platform")

    def test_without_a_platform_it_is_skipped_by_verify(self):
        result = dssbench("verify", "two_elements", "--variant", "reference,opencl", **NO_PLATFORM)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stdout, "opencl .*skipped .*no OpenCL platform")

    def test_an_unknown_device_is_told_with_the_known_ones(self):
        device = devices()[0]
        for name in ("no_such_device", "9:0", "0:99", "-1:0", "accelerator"):
            words = [f"--device {name}", "no such device", device["device"], device["name"]]
            self.assert_refused(2, words, *self.opencl("--device=" + name))
            self.assert_refused(2, words, "verify", "two_elements", "--variant", "opencl",
                                "--device=" + name)
        self.assert_refused(2, ['did you mean "cpu"'], *self.opencl("--device", "cpuu"))

    def test_a_device_is_found_by_number_kind_and_part_of_its_name_in_any_case(self):
        device = devices()[0]
        for name in (device["device"], device["kind"].upper(), device["name"][2:8].upper(),
                     device["platform"][:8].lower()):
            result = dssbench(*self.opencl("--device", name, "--json", "-"))
            self.assertEqual(result.returncode, 0, result.stderr)
            found = json.loads(result.stdout)
            self.assertEqual(found["device"]["kind"], device["kind"])
            self.assertGreater(found["first_step_s"], 0)

    def test_a_second_process_reads_the_binary_that_the_first_left(self):
        first, second = (json.loads(
            dssbench(*self.opencl("--json", "-"), **self.cache(self.path("cache"))).stdout)
                         for _ in range(2))
        self.assertEqual((first["build_is_cached"], second["build_is_cached"]), (False, True))
        self.assertEqual(first["state_digest"], second["state_digest"])

    def test_pocl_which_keeps_what_it_compiles_is_not_asked_for_binaries(self):
        if not any("Portable Computing Language" in device["platform"] for device in devices()[:1]):
            self.skipTest("the first device is another driver's")
        environment = {
            key: value for key, value in os.environ.items() if key != "DSSBENCH_CACHE_DIR"
        }
        result = dssbench(*self.opencl("--json", "-"),
                          env={**environment, "XDG_CACHE_HOME": self.path("cache")})
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(os.listdir(self.path("cache")), ["pocl"])

    def test_a_broken_binary_is_built_anew(self):
        cache = self.path("cache")
        whole = json.loads(dssbench(*self.opencl("--json", "-"), **self.cache(cache)).stdout)
        for name in os.listdir(cache):
            with open(os.path.join(cache, name), "r+b") as file:
                file.truncate(os.path.getsize(file.name) // 2)
        result = dssbench(*self.opencl("--json", "-"), **self.cache(cache))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(json.loads(result.stdout)["build_is_cached"], False)
        self.assertEqual(json.loads(result.stdout)["state_digest"], whole["state_digest"])

    def test_it_works_where_nothing_can_be_cached(self):
        result = dssbench(*self.opencl("--json", "-"), **self.cache("/proc/nowhere"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(json.loads(result.stdout)["build_is_cached"], False)


if __name__ == "__main__":
    unittest.main()
