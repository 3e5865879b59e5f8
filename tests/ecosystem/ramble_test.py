"""Runs what examples/ramble describes, without Ramble: its command and what it reads of the output.

Ramble is on no index of packages. This test stands in for the words of its language that the
application uses. examples/ramble/ramble.yaml says how to try it with Ramble itself.
"""
import importlib.util
import os
import pathlib
import re
import subprocess
import sys
import types
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
APPLICATION = ROOT / "examples/ramble/applications/dssbench/application.py"


class Application:
    """The application as Ramble sees it."""

    def __init__(self):
        self.commands, self.defaults, self.merits, self.criteria = {}, {}, {}, []
        language = types.ModuleType("ramble.appkit")
        language.ExecutableApplication = object
        language.executable = lambda name, command, use_mpi: self.commands.update({name: command})
        language.workload = lambda name, executables: None
        language.workload_variable = \
            lambda name, default, description, workloads: self.defaults.update({name: default})
        language.figure_of_merit = \
            lambda name, units, group_name, fom_regex: self.merits.update(
                {name: (re.compile(fom_regex), group_name)})
        language.success_criteria = lambda name, mode, match: self.criteria.append(match)
        sys.modules.update({"ramble": types.ModuleType("ramble"), "ramble.appkit": language})
        spec = importlib.util.spec_from_file_location("application", APPLICATION)
        spec.loader.exec_module(importlib.util.module_from_spec(spec))


class Ramble(unittest.TestCase):
    """The command of the application, run by the program under test."""

    def test_the_output_has_all_figures_of_merit_and_success(self):
        application = Application()
        values = {**application.defaults, "n_threads": 1, "steps": 20, "overrides": "--set n=12",
                  "variant": "scalar"}
        program, *words = application.commands["run"].format(**values).split()
        self.assertEqual(program, "dssbench")
        result = subprocess.run([os.environ["DSSBENCH"], *words], capture_output=True, text=True,
                                check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = result.stdout.splitlines()
        found = {name: [match[group] for match in map(regex.match, lines) if match]
                 for name, (regex, group) in application.merits.items()}
        self.assertEqual({name: len(values) for name, values in found.items()},
                         {"rate": 1, "wall time": 1, "state": 1})
        self.assertGreater(float(found["rate"][0]), 0)
        self.assertGreater(float(found["wall time"][0]), 0)
        self.assertRegex(found["state"][0], "^[0-9a-f]{16}$")
        for criterion in application.criteria:
            self.assertTrue(any(re.match(criterion, line) for line in lines))

    def test_no_pattern_has_braces_which_ramble_would_expand(self):
        application = Application()
        for regex, _ in application.merits.values():
            self.assertNotRegex(regex.pattern, r"\{")
        for criterion in application.criteria:
            self.assertNotRegex(criterion, r"\{")


if __name__ == "__main__":
    unittest.main()
