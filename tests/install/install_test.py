"""Installs the build tree, moves it, builds an outside variant against it, and runs that."""
import glob
import json
import os
import shutil
import subprocess
import tempfile
import unittest

from tiny_study import STUDY

BUILD, SOURCE, CMAKE = (os.environ[name] for name in ("BUILD", "SOURCE", "CMAKE"))


def finished(*command, **options):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True,
                          timeout=300, **options)


def must(*command, **options):
    result = finished(*command, **options)
    if result.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}\n{result.stdout}{result.stderr}")
    return result.stdout


class Install(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory(prefix="dssbench-install-")
        cls.addClassCleanup(holder.cleanup)
        cls.directory = os.path.realpath(holder.name)
        must(CMAKE, "--install", BUILD, "--prefix", cls.directory + "/first")
        cls.prefix = cls.directory + "/moved" # what is installed may be moved
        os.rename(cls.directory + "/first", cls.prefix)
        shutil.copytree(cls.prefix + "/share/dssbench/examples/variant", cls.directory + "/variant")
        must(CMAKE, "-S", cls.directory + "/variant", "-B", cls.directory + "/build",
             f"-DCMAKE_PREFIX_PATH={cls.prefix}", "-DCMAKE_BUILD_TYPE=Debug")
        must(CMAKE, "--build", cls.directory + "/build")
        cls.modules = cls.directory + "/build/variants"

    def dssbench(self, *arguments, **options):
        return finished(self.prefix + "/bin/dssbench", *arguments, cwd=self.directory, **options)

    def listed(self, what, *arguments):
        return json.loads(must(self.prefix + "/bin/dssbench", "list", what, "--json", *arguments))

    def refused(self, *arguments, **options):
        result = self.dssbench(*arguments, **options)
        self.assertEqual((result.returncode, result.stderr.count("\n")), (2, 1), result.stderr)
        return result.stderr

    def altered(self, name, **changes):
        """A directory with the outside variant and a changed description."""
        directory = os.path.join(self.directory, name)
        shutil.copytree(self.modules, directory)
        with open(directory + "/wider.json", encoding="utf-8") as file:
            description = json.load(file)
        with open(directory + "/wider.json", "w", encoding="utf-8") as file:
            json.dump({**description, **changes}, file)
        return directory

    def test_everything_that_the_installed_program_reads_is_installed(self):
        for what in ("variants", "scenes", "experiments"):
            here = self.listed(what)
            there = json.loads(must(os.environ["DSSBENCH"], "list", what, "--json"))
            key = what.removesuffix("s")
            self.assertEqual([item[key] for item in here], [item[key] for item in there])
            for item in here:
                self.assertTrue(item["path"].startswith(self.prefix), item["path"])
                # A variant for other processors, or of a missing library, has no module.
                status = item.get("status", "")
                lacks = any(why in status for why in ("built without", "not for ", "left out"))
                self.assertNotEqual(os.path.exists(item["path"]), lacks, item)
        installed = f"{self.prefix}/share/dssbench/experiments"
        for folder in ("scenes", "scenes/*", "platforms", "studies/*"):
            names = [name for suffix in ("json", "xml")
                     for name in glob.glob(f"{folder}/*.{suffix}",
                                           root_dir=f"{SOURCE}/experiments")]
            self.assertTrue(names)
            for name in names:
                self.assertTrue(os.path.exists(f"{installed}/{name}"), name)

    def test_the_installed_program_computes_and_measures(self):
        self.assertIn(
            "0 failed",
            must(self.prefix + "/bin/dssbench", "verify", "two_elements", "--variant", "reference"))
        record = json.loads(
            must(self.prefix + "/bin/dssbench", "run", "plate_paper", "--set", "n=10", "--steps",
                 "20", "--model", "planar", "--json", "-"))
        self.assertEqual(record["status"], "ok")
        # their scenes are installed, too
        for study in ("failures", "model_ladder", "continuum", "stability", "work_precision"):
            dry = self.dssbench("experiment", study, "--scale", "smoke", "--dry-run", "--out",
                                self.directory + "/results")
            self.assertEqual(dry.returncode, 0, dry.stderr)

    def test_the_manual_page_and_completions_are_installed(self):
        for file, word in (
            ("man/man1/dssbench.1", ".TH DSSBENCH"),
            ("bash-completion/completions/dssbench", "complete "),
            ("zsh/site-functions/_dssbench", "#compdef"),
            ("fish/vendor_completions.d/dssbench.fish", "complete "),
            ("dssbench/LICENSE", "BSD"),
        ):
            with open(f"{self.prefix}/share/{file}", encoding="utf-8") as text:
                self.assertIn(word, text.read())

    def test_an_outside_variant_is_listed_with_its_path_and_passes_verify(self):
        listed = {
            item["variant"]: item
            for item in self.listed("variants", "--variant-path", self.modules)
        }
        self.assertEqual((listed["wider"]["status"], listed["wider"]["from"]),
                         ("usable", self.modules + "/wider.so"))
        self.assertNotIn("wider", [item["variant"] for item in self.listed("variants")])
        result = self.dssbench("verify", "two_elements", "--variant", "wider", "--variant-path",
                               "build/variants")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        skipped = [line for line in result.stdout.splitlines() if " skipped  " in line]
        # what the variant or the scene lacks
        self.assertEqual(
            [line for line in skipped if "f32c" not in line and "starts with" not in line], [])
        self.assertRegex(result.stdout, r"\b[1-9]\d* checks passed, 0 failed")

    def test_an_outside_variant_is_never_the_choice_of_auto(self):
        run = ("run", "two_elements", "--steps", "10", "--json", "-")
        self.assertEqual(
            json.loads(self.dssbench(*run, "--variant-path", self.modules).stdout)["variant"],
            json.loads(self.dssbench(*run).stdout)["variant"])

    def test_processes_that_an_experiment_starts_know_it(self):
        study = {
            **STUDY, "experiment": "own",
            "cells": [{"scene": "two_elements", "variants": ["wider"]}],
            "base": ["wider"], "twin": "wider"
        }
        with open(self.directory + "/own.json", "w", encoding="utf-8") as file:
            json.dump(study, file)
        result = self.dssbench("experiment", "own.json", "--scale", "smoke", "--out", "results",
                               "--variant-path", "build/variants")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        with open(self.directory + "/results/raw/own.csv", encoding="utf-8") as file:
            self.assertIn("wider", file.read())
        rebuilt = self.altered("rebuilt")
        with open(rebuilt + "/wider.so", "ab") as file:
            file.write(b"0")
        refusal = self.refused("experiment", "own.json", "--scale", "smoke", "--out", "results",
                               "--resume", "--variant-path", rebuilt)
        self.assertIn("the records are of outside_variants", refusal)

    def test_it_may_also_be_named_by_the_environment(self):
        named = {**os.environ, "DSSBENCH_VARIANT_PATH": self.modules}
        self.assertEqual(
            self.dssbench("run", "two_elements", "--steps", "10", "--variant", "wider",
                          env=named).returncode, 0)

    def test_one_directory_named_twice_is_one(self):
        os.symlink(self.modules, self.directory + "/link")
        for named in ("build/variants", "build/variants/:./build/../build/variants", self.modules,
                      "link"):
            result = self.dssbench("list", "variants", "--json", "--variant-path", "build/variants",
                                   env={**os.environ, "DSSBENCH_VARIANT_PATH": named})
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(
                [item["path"] for item in json.loads(result.stdout) if item["variant"] == "wider"],
                [self.modules + "/wider.so"])

    def test_processes_know_relative_paths_of_the_environment(self):
        study = {
            **STUDY, "experiment": "relative",
            "cells": [{"scene": "two_elements", "variants": ["wider"]}],
            "base": ["wider"], "twin": "wider"
        }
        with open(self.directory + "/relative.json", "w", encoding="utf-8") as file:
            json.dump(study, file)
        result = self.dssbench("experiment", "relative.json", "--scale", "smoke", "--out",
                               "results",
                               env={**os.environ, "DSSBENCH_VARIANT_PATH": "build/variants"})
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_a_path_of_the_environment_that_is_no_longer_there_keeps_nothing_from_running(self):
        stale = {**os.environ, "DSSBENCH_VARIANT_PATH": f"no/such:{self.modules}:/no/such"}
        self.assertEqual(
            self.dssbench("run", "two_elements", "--steps", "10", "--variant", "reference",
                          env=stale).returncode, 0)
        self.assertEqual(
            self.dssbench("run", "two_elements", "--steps", "10", "--variant", "wider",
                          env=stale).returncode, 0)

    def test_a_directory_that_is_not_there_is_refused(self):
        for arguments in (("list", "variants"), ("compare", "a", "b")):
            self.assertIn("--variant-path no/such: no such directory",
                          self.refused(*arguments, "--variant-path", "no/such"))

    def test_a_name_that_exists_is_refused_with_both_places(self):
        self.assertRegex(
            self.refused("list", "variants", "--variant-path",
                         self.altered("twice", variant="scalar")),
            "scalar exists already, in this program")
        again = self.altered("again")
        both = ("--variant-path", self.modules, "--variant-path", again)
        self.assertIn(f"wider exists already, in {self.modules}/wider.so",
                      self.refused("list", "variants", *both))

    def test_a_name_that_means_something_else_is_refused(self):
        for folder, name in (
            ("none", ""),
            ("auto", "auto"),
            ("colon", "mpi:wider"),
            ("comma", "a,b"),
        ):
            self.assert_only_its_choice_is_refused("is no name for a variant",
                                                   self.altered(folder, variant=name))

    def test_a_module_that_needs_another_cpu_is_not_opened(self):
        hidden = {**os.environ, "DSSBENCH_HIDE_CPU_FEATURES": "bmi2"}
        directory = self.altered("needy", needs=["bmi2"])
        # an empty file: opening it would fail in another way
        with open(directory + "/wider.so", "wb"):
            pass
        path = ("--variant-path", directory)
        self.assertIn("this CPU lacks bmi2",
                      self.refused("run", "two_elements", "--variant", "wider", *path, env=hidden))
        self.assert_only_its_choice_is_refused('did you mean "avx512f"',
                                               self.altered("odd", needs=["avx512g"]))

    def assert_only_its_choice_is_refused(self, words, directory, is_described=False):
        """The outside variant is listed as unusable, unless only its module tells; others run."""
        path = ("--variant-path", directory)
        listed = {item["variant"]: item for item in self.listed("variants", *path)}
        self.assertIn("usable" if is_described else words, listed["wider"]["status"])
        self.assertEqual(listed["reference"]["status"], "usable")
        self.assertEqual(
            self.dssbench("run", "two_elements", "--steps", "10", "--variant", "reference",
                          *path).returncode, 0)
        for command in ("run", "verify"):
            self.assertIn(words, self.refused(command, "two_elements", "--variant", "wider", *path))

    def test_a_module_without_description_is_refused_with_what_would_be_right(self):
        directory = self.altered("mute")
        os.remove(directory + "/wider.json")
        self.assert_only_its_choice_is_refused(
            "wider.json: cannot be read, so nobody knows what CPU its module needs; right is",
            directory)
        for text in ("{", "[]", '{"variant": "wider"}',
                     '{"variant": "wider", "isa": "x", "needs": "bmi2"}'):
            with open(directory + "/wider.json", "w", encoding="utf-8") as file:
                file.write(text)
            self.assert_only_its_choice_is_refused("wider.json: ", directory)

    def test_folders_are_no_modules_and_a_broken_one_takes_no_name(self):
        directory = self.altered("mixed")
        os.mkdir(directory + "/d.so")
        for name in ("scalar", "wider2", "auto"):
            with open(f"{directory}/{name}.so", "w", encoding="utf-8"):
                pass
        # valid except for this, with the name of a valid one
        with open(directory + "/wider2.json", "w", encoding="utf-8") as file:
            json.dump({"variant": "wider", "isa": "x86-64", "needs": "none"}, file)
        path = ("--variant-path", directory)
        listed = {item["variant"]: item for item in self.listed("variants", *path)}
        self.assertEqual([name for name in listed if name.startswith(directory)],
                         [f"{directory}/{name}.so" for name in ("auto", "scalar", "wider2")])
        for name in ("scalar", "wider", "auto"):
            self.assertEqual(
                self.dssbench("run", "two_elements", "--steps", "10", "--variant", name,
                              *path).returncode, 0, name)

    def test_a_program_that_is_not_in_bin_is_not_an_installed_one(self):
        os.mkdir(self.prefix + "/tools")
        shutil.copy(self.prefix + "/bin/dssbench", self.prefix + "/tools")
        for item in json.loads(must(self.prefix + "/tools/dssbench", "list", "scenes", "--json")):
            self.assertTrue(item["path"].startswith(SOURCE), item["path"])

    def test_what_march_and_options_use_is_needed_without_being_said(self):
        directory = self.directory + "/needs"
        os.mkdir(directory)
        with open(directory + "/CMakeLists.txt", "w", encoding="utf-8") as file:
            file.write(
                "cmake_minimum_required(VERSION 3.25)\nproject(needs LANGUAGES CXX)\n"
                "find_package(dssbench REQUIRED)\n"
                "dssbench_add_variant(least MARCH x86-64 SOURCES plugin.cpp)\n"
                "dssbench_add_variant(v4 MARCH x86-64-v4 SOURCES plugin.cpp)\n"
                "dssbench_add_variant(more MARCH x86-64-v3 NEEDS avx512vnni avx2 "
                "OPTIONS -O3 -mavx512f SOURCES plugin.cpp)\n"
            )
        shutil.copy(self.directory + "/variant/plugin.cpp", directory)
        must(CMAKE, "-S", directory, "-B", directory + "/build",
             f"-DCMAKE_PREFIX_PATH={self.prefix}")
        needs = {}
        for name in ("least", "v4", "more"):
            with open(f"{directory}/build/variants/{name}.json", encoding="utf-8") as file:
                needs[name] = json.load(file)["needs"]
        self.assertEqual(needs["least"], [])
        self.assertLessEqual({"avx2", "fma", "bmi2", "avx512f", "avx512dq", "avx512bw", "avx512vl"},
                             set(needs["v4"]))
        self.assertLessEqual({"avx2", "fma", "bmi2", "avx512f", "avx512vnni"}, set(needs["more"]))
        self.assertEqual(len(needs["more"]), len(set(needs["more"])))

    def with_plugin(self, name, abi, layout, own_name='"wider"', result="&plugin"):
        """A module that describes itself so and can do nothing."""
        directory = self.altered(name)
        with open(directory + "/plugin.cpp", "w", encoding="utf-8") as file:
            file.write(
                '#include "variants/api/api.hpp"\n'
                'static constexpr dss::Plugin plugin{.abi = ' + abi + ', .name = ' + own_name +
                ', .isa = "x", .has_fma = false, .is_threaded = false,\n'
                '  .is_distributed = false, .create = nullptr, .kernels = nullptr, .layout = ' +
                layout + '};\n'
                'extern "C" const dss::Plugin* dss_plugin() { return ' + result + '; }\n')
        must(os.environ["CXX"], "-std=c++20", "-shared", "-fPIC",
             f"-I{self.prefix}/include/dssbench", directory + "/plugin.cpp", "-o",
             directory + "/wider.so")
        return directory

    def test_a_module_of_another_interface_or_other_headers_is_refused(self):
        for name, abi, layout, words in (
            ("abi", "dss::plugin_abi + 1", "dss::plugin_layout", "speaks interface"),
            ("layout", "dss::plugin_abi", "1", "was compiled with other headers"),
        ):
            self.assert_only_its_choice_is_refused(words, self.with_plugin(name, abi, layout),
                                                   is_described=True)

    def test_a_module_that_gives_null_is_refused(self):
        right = ("dss::plugin_abi", "dss::plugin_layout")
        for words, directory in (
            ("gives no name, isa or create", self.with_plugin("no_create", *right)),
            ("gives no name, isa or create",
             self.with_plugin("no_name", *right, own_name="nullptr")),
            ("gives no Plugin",
             self.with_plugin("no_plugin", *right, result="plugin.abi == 0 ? &plugin : nullptr")),
        ):
            self.assert_only_its_choice_is_refused(words, directory, is_described=True)

    def test_a_list_runs_no_code_of_a_module(self):
        directory = self.with_plugin("loud", "dss::plugin_abi", "dss::plugin_layout")
        trace = directory + "/it_ran"
        with open(directory + "/plugin.cpp", "a", encoding="utf-8") as file:
            file.write('#include <fstream>\n'
                       f'static const bool ran = (std::ofstream("{trace}") << 1, true);\n')
        must(os.environ["CXX"], "-std=c++20", "-shared", "-fPIC",
             f"-I{self.prefix}/include/dssbench", directory + "/plugin.cpp", "-o",
             directory + "/wider.so")
        path = ("--variant-path", directory)
        self.assertIn("wider", [item["variant"] for item in self.listed("variants", *path)])
        self.dssbench("run", "two_elements", "--variant", "reference", "--steps", "1", *path)
        self.assertFalse(os.path.exists(trace))
        self.refused("run", "two_elements", "--variant", "wider", *path)
        self.assertTrue(os.path.exists(trace))


if __name__ == "__main__":
    unittest.main()
