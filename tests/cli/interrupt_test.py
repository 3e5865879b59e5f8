"""Ctrl-C and kill: nothing is left behind, one line says how to go on, and going on works."""
import os
import pathlib
import re
import signal
import subprocess
import time
import unittest

from program import PROGRAM, dssbench, why_no_variant
from simulate_test import WITHOUT
from tiny_study import STUDY, TinyStudyTest

LONG = ("plate_paper", "--set", "n=60", "--steps", "50000000")


def processes_of(session):
    """Processes of a session that have not ended."""
    found = []
    for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            state, _, _, its_session = stat.read_text().rpartition(")")[2].split()[:4]
        except OSError:
            continue
        if int(its_session) == session and state != "Z":
            found.append(stat.parent.name)
    return found


def does_catch(process, number):
    """True if a process has a handler for a signal: before, a signal only ends it."""
    try:
        status = pathlib.Path(f"/proc/{process}/status").read_text()
    except OSError:
        return False
    return bool(int(re.search(r"SigCgt:\s*(\w+)", status)[1], 16) >> (number - 1) & 1)


class Interrupts(TinyStudyTest):
    def start(self, *arguments):
        os.makedirs(self.path("tmp"), exist_ok=True)
        return subprocess.Popen([PROGRAM, *map(str, arguments)], stdout=subprocess.DEVNULL,
                                stderr=subprocess.PIPE, text=True, start_new_session=True,
                                cwd=self.directory,
                                env={**os.environ, "TMPDIR": self.path("tmp")})

    def end(self, run, number=signal.SIGINT, after_s=0.5):
        """Interrupts the terminal's foreground group, as Ctrl-C does. Returns the line."""
        self.wait_for(lambda: run.poll() is not None or does_catch(run.pid, number))
        time.sleep(after_s)
        self.assertIsNone(run.poll(), "it ended before it was interrupted")
        os.killpg(run.pid, number)
        errors = run.communicate(timeout=60)[1]
        self.assertEqual(run.returncode, -number, errors)
        self.assertEqual(len([line for line in errors.splitlines()
                              if line.startswith("dssbench: ")]), 1, errors)
        for _ in range(50):
            if not processes_of(run.pid):
                break
            time.sleep(0.1)
        self.assertEqual(processes_of(run.pid), [])
        self.assertEqual([name for name in os.listdir(self.path("tmp"))
                          if name.startswith("dssbench")], [])
        return errors

    def wait_for(self, is_so, limit_s=60):
        end = time.monotonic() + limit_s
        while not is_so():
            self.assertLess(time.monotonic(), end)
            time.sleep(0.05)

    def shared_memory(self):
        return {name for name in os.listdir("/dev/shm") if re.search("vader|osc|sm_", name)}

    def test_commands_leave_nothing_behind(self):
        for command in (("run", *LONG, "--json", "run.json", "--state", "end.csv"),
                        ("advise", "plate_paper", "--set", "n=60", "--tolerance", "1e-8"),
                        ("verify",),
                        ("bench", "--out", "bench", "--min-time", "2")):
            for number in (signal.SIGINT, signal.SIGTERM):
                line = self.end(self.start(*command), number)
                self.assertIn("dssbench: interrupted", line)
        self.assertEqual([path for path in pathlib.Path(self.directory).rglob("*")
                          if path.name.endswith((".part", ".lock"))], [])

    @unittest.skipIf(WITHOUT, WITHOUT)
    def test_a_simulation_leaves_nothing_behind(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            run = self.start("simulate", "plate_paper", "--set", "n=600", "--ranks", "256",
                             "--node-speed", "1e7", "--steps", "10000", "--json", "cluster.json")
            self.wait_for(lambda: len(processes_of(run.pid)) > 1 or run.poll() is not None)
            self.assertIn("dssbench: interrupted", self.end(run, number))
        self.assertFalse(os.path.exists(self.path("cluster.json")))

    @unittest.skipIf(why_no_variant("mpi"), why_no_variant("mpi") or "")
    def test_ranks_leave_no_shared_memory(self):
        before = self.shared_memory()
        for number in (signal.SIGINT, signal.SIGTERM):
            run = self.start("run", *LONG, "--ranks", "2")
            self.wait_for(lambda: self.shared_memory() - before)
            self.assertIn("dssbench: interrupted", self.end(run, number))
        self.assertEqual(self.shared_memory() - before, set())

    def long_study(self):
        scale = {**STUDY["scales"]["smoke"], "steps": 2000, "repetitions": [40, 40]}
        self.study(scales={"smoke": scale})
        return ("experiment", self.path("tiny.json"), "--scale", "smoke", "--out",
                self.path("out"))

    def test_an_interrupted_study_goes_on(self):
        command = self.long_study()
        run = self.start(*command)
        self.wait_for(lambda: os.path.exists(self.path("out/raw/tiny.csv")))
        line = self.end(run, after_s=0.3)
        self.assertIn("go on with --resume", line)
        done = self.rows("raw")
        self.assertTrue(0 < len(done) < 3 * 40, len(done))
        scale = {**STUDY["scales"]["smoke"], "steps": 2000, "repetitions": [2, 2]}
        self.study(scales={"smoke": scale})
        result = dssbench(*command, "--resume")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.rows("raw")[:len(done)], done)

    def test_a_study_has_one_writer(self):
        command = self.long_study()
        first = self.start(*command)
        self.wait_for(lambda: os.path.exists(self.path("out/raw/tiny.csv.lock")))
        for again in ((), ("--resume",)):
            self.assert_refused(2, [f"process {first.pid}, since 20", "another --out"], *command,
                                *again)
        first.kill()
        first.communicate()
        scale = {**STUDY["scales"]["smoke"], "repetitions": [1, 1]}
        self.study(scales={"smoke": scale})
        self.assertEqual(dssbench(*command).returncode, 0)

    def test_the_index_of_a_series_is_current(self):
        run = self.start("run", "plate_paper", "--set", "n=30", "--steps", "4000000",
                         "--output", "f.vtu", "--frames", "4000")
        index = pathlib.Path(self.path("f.pvd"))
        self.wait_for(lambda: index.exists() and "f_0001" in index.read_text())
        self.end(run, after_s=0)
        listed = re.findall('file="([^"]+)"', self.read("f.pvd"))
        self.assertGreater(len(listed), 1)
        for name in listed:
            self.assertIn("</VTKFile>", self.read(name)[-20:])

    def test_temporary_files_follow_no_planted_link(self):
        target = self.write("target", "untouched")
        os.makedirs(self.path("tmp"))
        # exec keeps the number of the process, which names files of earlier versions
        plant = (f"ln -s {target} end.json.$$.part; ln -s {target} tmp/dssbench-$$-1.json; "
                 f"exec {PROGRAM} simulate plate_paper --set n=20 --ranks 2 --json end.json "
                 "--platform gigabit")
        run = subprocess.run(["sh", "-c", plant], capture_output=True, text=True,
                             cwd=self.directory,
                             env={**os.environ, "TMPDIR": self.path("tmp")})
        self.assertIn(run.returncode, (0, 2), run.stderr)
        self.assertEqual(self.read("target"), "untouched")


if __name__ == "__main__":
    unittest.main()
