"""Help of every command, and the manual page that is made from it."""
import json
import os
import re
import shlex
import shutil
import subprocess
import unittest

from program import ProgramTest, dssbench

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
COMMANDS = dssbench("complete", "").stdout.split()


class Help(ProgramTest):
    def test_every_command_has_help_with_an_example_of_it(self):
        self.assertLess(10, len(COMMANDS))
        self.assertIn("Example: dssbench ", dssbench("--help").stdout)
        for command in COMMANDS:
            result = dssbench(command, "--help")
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            self.assertIn("Example: dssbench " + command, result.stdout)
            self.assertEqual(result.stdout, dssbench("help", command).stdout)
        self.assertEqual(dssbench("--help").stdout, dssbench("help").stdout)

    def test_the_version_names_commit_build_and_packages(self):
        result = dssbench("--version")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertRegex(result.stdout, r"^dssbench \d+\.\d+\.\d+, commit (unknown|[0-9a-f]{12})")
        self.assertRegex(result.stdout, r"(?m)^built by \S+ \d")
        self.assertRegex(result.stdout, r"(?m)^with .*libxsimd-dev \d")

    def test_options_of_examples_are_options(self):
        for command in COMMANDS:
            text = dssbench(command, "--help").stdout
            examples = re.findall(r"^(?:Example:|        ) dssbench (.*)$", text, re.M)
            self.assertTrue(examples, command)
            for example in examples:
                words = shlex.split(example.split("|")[0].split(">")[0], comments=True)
                self.assertEqual(words[0], command)
                for option in (word for word in words if re.match("--.", word)):
                    self.assertIn(option,
                                  dssbench("complete", command, option).stdout.split(), example)

    def test_the_scene_that_is_shown_to_newcomers_runs(self):
        with open(os.path.join(ROOT, "solver/scene/README.md"), encoding="utf-8") as file:
            scene = re.search(r"^    \{$.*?^    \}$", file.read(), re.M | re.S).group(0)
        result = dssbench("run", self.write("hanging_strip.json", scene), "--variant", "reference",
                          "--json", "-")
        self.assertEqual((result.returncode, json.loads(result.stdout)["status"]), (0, "ok"),
                         result.stderr)

    def page(self):
        result = dssbench("help", "--man")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return self.write("dssbench.1", result.stdout)

    @unittest.skipUnless(shutil.which("groff"), "groff is not installed")
    def test_the_manual_page_has_every_command_and_option_and_no_warning(self):
        page = subprocess.run(
            ["groff", "-man", "-Tascii", "-rLL=150n", "-P-cbou", "-ww", self.page()],
            capture_output=True, text=True, timeout=60,
        )
        self.assertEqual((page.returncode, page.stderr), (0, ""))
        sections = re.split(r"^   (?=\w)", page.stdout, flags=re.M)
        for command in COMMANDS:
            section = next(text for text in sections if text.startswith(command + "\n"))
            self.assertIn("Example: dssbench " + command, section)
            for option in re.findall(r"^  (?:-\w,)?(--[\w-]+)",
                                     dssbench(command, "--help").stdout, re.M):
                self.assertIn(option, section)
        for heading in ("NAME", "SYNOPSIS", "OPTIONS", "COMMANDS", "EXIT STATUS", "ENVIRONMENT",
                        "EXAMPLES"):
            self.assertRegex(page.stdout, rf"(?m)^{heading}$")

    def test_the_manual_page_has_every_variable_that_the_program_reads(self):
        with open(self.page(), encoding="utf-8") as file:
            page = file.read()
        read = set()
        for folder in ("solver", "variants", "experiments"):
            for directory, _, names in os.walk(os.path.join(ROOT, folder)):
                for name in names:
                    if name.endswith((".cpp", ".hpp")):
                        with open(os.path.join(directory, name), encoding="utf-8") as file:
                            read |= set(re.findall(r"\"(DSSBENCH_[A-Z_]+)\"", file.read()))
        self.assertLess(5, len(read))
        for variable in read:
            self.assertIn(variable, page)


if __name__ == "__main__":
    unittest.main()
