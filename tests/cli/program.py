"""Runs the program under test. Its path is in the environment variable DSSBENCH."""
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["DSSBENCH"]


def dssbench(*arguments, **options):
    """The finished process, with its output as text."""
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          timeout=300, **options)


def record(*arguments, **options):
    """The JSON record of a command that must end well."""
    result = dssbench(*arguments, "--json", "-", **options)
    if result.returncode != 0:
        raise AssertionError(result.stderr)
    return json.loads(result.stdout)


def shipped_scene(name):
    """The JSON of a shipped scene, to be changed and written elsewhere."""
    path = pathlib.Path(__file__).parents[2] / "experiments" / "scenes" / f"{name}.json"
    return json.loads(path.read_text(encoding="utf-8"))


def why_no_variant(name):
    """None if the variant runs here."""
    listed = json.loads(dssbench("list", "variants", "--json").stdout)
    status = {row["variant"]: row["status"] for row in listed}.get(name, "not built")
    return None if status == "usable" else f"variant {name}: {status}"


class ProgramTest(unittest.TestCase):
    """A test with a directory of its own in self.directory."""

    def setUp(self):
        holder = tempfile.TemporaryDirectory(prefix="dssbench-cli-")
        self.addCleanup(holder.cleanup)
        self.directory = holder.name

    def path(self, name):
        return os.path.join(self.directory, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        return self.path(name)

    def read(self, name):
        with open(self.path(name), encoding="utf-8", errors="surrogateescape") as file:
            return file.read()

    def assert_refused(self, exit_code, words, *arguments, **options):
        """The command ends with this code, and its one line of error has all of these words."""
        result = dssbench(*arguments, **options)
        self.assertEqual(result.returncode, exit_code, result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertEqual(result.stdout, "")
        for word in words:
            self.assertIn(word, result.stderr)
