"""Shared by tests of runs: their records, ensembles, and checkpoints in the test's directory."""
import copy
import functools
import json
import operator
import os
import pathlib
import subprocess
import time

from program import PROGRAM, ProgramTest, dssbench


def members_of(record):
    return record["ensemble"]["members"]


def places(value, place=()):
    """Yields the keys that lead to everything inside a value."""
    for key in value if isinstance(value, dict) else range(len(value)):
        yield (*place, key)
        if isinstance(value[key], (dict, list)):
            yield from places(value[key], (*place, key))


def text_digest(text):
    """The digest of a head (solver/digest.hpp)."""
    digest = 0xcbf29ce484222325
    for byte in text.encode():
        digest = (digest ^ byte) * 0x100000001b3 % 2**64
    return f"{digest:016x}"


class RunTest(ProgramTest):
    def run_json(self, *arguments, code=0):
        """@return the record of a run that ends with this exit code"""
        result = dssbench("run", *arguments, "--json", "-", cwd=self.directory)
        self.assertEqual(result.returncode, code, result.stderr)
        return json.loads(result.stdout)

    def members(self, *sets):
        """@return the file of an ensemble; a member for each set of overrides"""
        return self.write("m.json", json.dumps({"members": [{"set": own} for own in sets]}))

    def save(self, *arguments, every, code=0):
        """@return the record of a run that leaves c.ckpt and c.ckpt.previous"""
        return self.run_json(*arguments, "--checkpoint", "c.ckpt", "--checkpoint-every", every,
                             code=code)

    def head(self, name):
        """@return the head of a checkpoint"""
        return json.loads(pathlib.Path(self.path(name)).read_bytes().split(b"\n", 2)[1])

    def assert_altered_heads_are_harmless(self, whole, name, *arguments, code=0):
        """Heads with one other value and the right digest are refused, or change no bit."""
        first, _, _, blocks = pathlib.Path(self.path(name)).read_bytes().split(b"\n", 3)
        head, refused = self.head(name), 0
        for place in places(head):
            for value in (None, -7, 2**62, "text"):
                altered = copy.deepcopy(head)
                *parents, last = place
                functools.reduce(operator.getitem, parents, altered)[last] = value
                text = json.dumps(altered)
                pathlib.Path(self.path(name)).write_bytes(
                    b"\n".join([first, text.encode(), text_digest(text).encode(), blocks]))
                result = dssbench("run", *arguments, "--restart", name, "--json", "-",
                                  cwd=self.directory)
                self.assertIn(result.returncode, (code, 2), (place, value, result.stderr))
                self.assertLessEqual(result.stderr.count("\n"), 1, (place, value, result.stderr))
                refused += result.returncode == 2
                if result.returncode == code:
                    self.assertEqual(json.loads(result.stdout)["state_digest"],
                                     whole["state_digest"], (place, value))
        return refused

    def interrupted(self, number, *arguments):
        """Interrupts a long run after it has saved itself. @return its line"""
        with subprocess.Popen([PROGRAM, "run", *arguments, "--checkpoint", "c.ckpt"],
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                              start_new_session=True, cwd=self.directory) as run:
            end = time.monotonic() + 60
            while not os.path.exists(self.path("c.ckpt")):
                self.assertLess(time.monotonic(), end)
                time.sleep(0.02)
            os.killpg(run.pid, number)
            line = run.communicate(timeout=60)[1]
        self.assertEqual(run.returncode, -number, line)
        self.assertEqual(line.count("dssbench: "), 1, line)
        self.assertIn("--restart c.ckpt", line)
        return line
