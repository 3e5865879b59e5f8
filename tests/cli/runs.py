"""Shared by tests of runs: their records, ensembles, and checkpoints in the test's directory."""
import json
import os
import pathlib
import subprocess
import time

from program import PROGRAM, ProgramTest, dssbench


def members_of(record):
    return record["ensemble"]["members"]


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
