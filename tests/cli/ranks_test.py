"""Runs on several ranks: the bits of one process, refusals, and jobs in which a rank fails."""
import functools
import json
import os
import pathlib
import shutil
import signal
import subprocess
import time
import unittest

import program
from program import PROGRAM, ProgramTest, dssbench

STRATEGIES = ("sendrecv", "overlap", "deep", "deep-overlap", "shared")
PLATE = ("run", "plate_paper", "--set", "n=12", "--steps", "30")
UNSTABLE = ("run", "plate_paper", "--set", "n=10", "--dt", "5e-6", "--force", "--steps", "5000")
ENDLESS = ("run", "plate_paper", "--set", "n=24", "--steps", "1000000000")
MPIRUN = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def why_no_ranks():
    """Why nothing can be tested here; empty if it can."""
    status = {
        row["variant"]: row["status"]
        for row in json.loads(dssbench("list", "variants", "--json").stdout)
    }
    if status.get("mpi") != "usable":
        return "variant mpi: " + status.get("mpi", "not built")
    return "" if shutil.which("mpirun") else "mpirun is not installed"


WHY_NOT = why_no_ranks()


record = functools.lru_cache(maxsize=None)(program.record)  # equal runs are made once


def mpirun(ranks, *arguments):
    """The program, started by an mpirun of the user."""
    command = [
        "mpirun", "-np", str(ranks), "--oversubscribe", "--bind-to", "none", PROGRAM, *arguments
    ]
    return subprocess.run(command, capture_output=True, text=True, timeout=300,
                          env={**os.environ, **MPIRUN})


def own_lines(result):
    """The program's own lines on standard error. mpirun adds others to a job that fails."""
    return [line for line in result.stderr.splitlines() if line.startswith("dssbench: ")]


def processes(word):
    """Running processes with this word on their command line: {process: its environment}."""
    found = {}
    for folder in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            state = (folder / "stat").read_text(encoding="utf-8").rpartition(")")[2].split()[0]
            if state not in "ZX" and word.encode() in (folder / "cmdline").read_bytes():
                found[int(folder.name)] = (folder / "environ").read_bytes()
        except (OSError, IndexError):
            pass  # it has just ended
    return found


@unittest.skipIf(WHY_NOT, WHY_NOT)
class Bits(ProgramTest):
    def test_adaptive_steps_are_those_of_one_process(self):
        adaptive = (*PLATE, "--integrator", "dopri5", "--rtol", "1e-5")
        one = record(*adaptive)
        for ranks, halo in ((2, "sendrecv"), (3, "deep-overlap"), (2, "shared"), (2, "auto")):
            other = record(*adaptive, "--ranks", str(ranks), "--halo", halo)
            for key in ("state_digest", "steps", "rejected_steps", "least_step_s"):
                self.assertEqual(other[key], one[key], (halo, key))

    def test_samples_have_the_bits_of_the_first_run_with_equal_and_adaptive_steps(self):
        adaptive = (*PLATE, "--integrator", "dopri5", "--rtol", "1e-5")
        for run in (PLATE, adaptive):
            found = record(*run, "--ranks", "2", "--samples", "3")
            self.assertEqual((found["status"], found["samples"]), ("ok", 3), run)
            self.assertEqual(found["state_digest"], record(*run)["state_digest"], run)

    def test_states_equal_those_of_one_process_with_each_strategy(self):
        # on ranks, auto takes only proven models
        scenes = (PLATE, ("run", "l_bracket", "--steps", "30", "--model", "spatial"))
        for number, strategy in enumerate(STRATEGIES):
            for place, scene in enumerate(scenes):
                ranks, precision = 2 + (number + place) % 2, ("f64", "f32")[number // 2 % 2]
                with self.subTest(scene=scene[1], precision=precision, ranks=ranks, halo=strategy):
                    one = record(*scene, "--precision", precision)
                    several = record(*scene, "--precision", precision, "--ranks", str(ranks),
                                     "--halo", strategy)
                    self.assertEqual((several["ranks"], several["halo"]), (ranks, strategy))
                    self.assertEqual(several["state_digest"], one["state_digest"])

    def test_verify_compares_every_decomposition_and_strategy(self):
        result = dssbench("verify", "two_bodies", "plate_paper", "--ranks", "2,3", "--quiet")
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assertNotIn("FAILED", result.stdout)
        passed, failed = (int(result.stdout.splitlines()[-1].split()[place]) for place in (0, 3))
        self.assertGreater(passed, 100)
        self.assertEqual(failed, 0)
        reasons = [
            line.split(" (and ")[0].split("skipped  ")[-1]
            for line in result.stdout.splitlines()
            if "skipped  " in line
        ]
        self.assertEqual(len(reasons), len(set(reasons)))  # one row a reason

    def test_deep_sends_a_quarter_of_the_messages_and_the_same_bytes(self):
        every_stage, once = (record(*PLATE, "--ranks", "2", "--halo", halo)
                             for halo in ("sendrecv", "deep"))
        self.assertEqual((every_stage["messages_per_step"], once["messages_per_step"]), (2 * 4, 2))
        self.assertEqual(every_stage["bytes_per_step"], once["bytes_per_step"])

    def test_files_of_two_ranks_are_those_of_one_process(self):
        for ranks in ("1", "2"):
            folder = pathlib.Path(self.path(ranks))
            folder.mkdir()
            result = dssbench(*PLATE, "--ranks", ranks, "--state", "s.csv", "--output", "p.vtu",
                              "--frames", "2", cwd=folder)
            self.assertEqual(result.returncode, 0, result.stderr)
        names = ["p.pvd", "p_0000.vtu", "p_0001.vtu", "p_0002.vtu", "s.csv"]
        for ranks in ("1", "2"):
            self.assertEqual(sorted(os.listdir(self.path(ranks))), names)
        for name in names:
            one, two = (pathlib.Path(self.path(ranks), name).read_bytes() for ranks in ("1", "2"))
            self.assertEqual(one, two, name)

    def test_an_unstable_run_ends_at_the_same_step_time_and_element(self):
        one = dssbench(*UNSTABLE)
        self.assertIn("not finite after step", one.stderr)
        for halo in STRATEGIES:
            two = dssbench(*UNSTABLE, "--ranks", "2", "--halo", halo)
            self.assertEqual((two.returncode, two.stdout, two.stderr), (3, "", one.stderr), halo)


@unittest.skipIf(WHY_NOT, WHY_NOT)
class Decompositions(ProgramTest):
    def parts_file(self, parts):
        path = self.path(f"{parts}.json")
        result = dssbench("decompose", "plate_paper", "--set", "n=12", "--parts", parts, "--method",
                          "blocks", "--output", path)
        self.assertEqual(result.returncode, 0, result.stderr)
        return path

    def test_a_file_of_decompose_is_used(self):
        path = self.parts_file(2)
        document = json.loads(self.read("2.json"))
        document["method"] = "by hand"
        for part, segments in zip(
                document["parts"],
            ([[row, 0, 12] for row in range(3)], [[row, 0, 12] for row in range(3, 12)])):
            part["segments"] = segments
            del part["own_elements"]
        self.write("2.json", json.dumps(document))
        several = record(*PLATE, "--ranks", "2", "--halo", "deep", "--decomposition", path)
        self.assertEqual((several["decomposition"], several["imbalance"]), ("by hand", 1.5))
        self.assertEqual(several["state_digest"], record(*PLATE)["state_digest"])

    def test_a_decomposition_that_does_not_fit_is_refused(self):
        path = self.parts_file(2)
        self.assert_refused(2, ["2.json", "2 parts", "3 ranks", "--ranks 2"], *PLATE, "--ranks",
                            "3", "--decomposition", path)
        self.assert_refused(2, ["2.json", "144", "100", "size"], "run", "plate_paper", "--set",
                            "n=10", "--ranks", "2", "--decomposition", path)
        self.assert_refused(2, ["2 rows", "at most 2"], "run", "plate_paper", "--set", "n=2",
                            "--ranks", "3")

    def test_a_slow_rank_gets_a_part_in_proportion_to_its_measured_speed(self):
        slow = {"env": {**os.environ, "DSSBENCH_FAULT": "slow:1:10"}}
        result = dssbench("run", "plate_paper", "--set", "n=60", "--steps", "20", "--ranks", "2",
                          "--halo", "deep", "--shares", "measured", "--json", "-", **slow)
        self.assertEqual(result.returncode, 0, result.stderr)
        # 1.8 on idle cores: ten of eleven parts of the elements on rank 0
        imbalance = json.loads(result.stdout)["imbalance"]
        self.assertGreater(imbalance, 1.2)
        self.assertLess(imbalance, 2)


@unittest.skipIf(WHY_NOT, WHY_NOT)
class Refusals(ProgramTest):
    def test_unknown_words_are_told_with_the_nearest_in_one_line(self):
        for option, word, nearest in (
            ("--halo", "depe", '"deep"'),
            ("--decomposition", "stripes", '"strips"'),
            ("--shares", "mesured", '"measured"'),
        ):
            self.assert_refused(2, [word, nearest], *PLATE, "--ranks", "2", option, word)

    def test_no_ranks_and_a_variant_that_computes_no_parts_are_refused(self):
        self.assert_refused(2, ["--ranks 0", "1 to"], *PLATE, "--ranks", "0")
        self.assert_refused(2, ["reference", "does not compute parts"], *PLATE, "--ranks", "2",
                            "--variant", "reference")

    def test_without_mpirun_there_is_one_rank_and_a_reason(self):
        nowhere = {"env": {**os.environ, "PATH": self.directory}}
        result = dssbench(*PLATE, "--variant", "mpi", "--json", "-", **nowhere)
        self.assertEqual(result.returncode, 0, result.stderr)
        alone = json.loads(result.stdout)
        self.assertEqual((alone["ranks"], alone["state_digest"]),
                         (1, record(*PLATE)["state_digest"]))
        self.assertTrue(alone["variant"].startswith("mpi:"))
        self.assert_refused(2, ["--ranks 2", "mpirun is not installed"], *PLATE, "--ranks", "2",
                            **nowhere)


@unittest.skipIf(WHY_NOT, WHY_NOT)
class UnderMpirun(ProgramTest):
    def test_a_job_that_mpirun_starts_prints_one_result_and_writes_its_files_once(self):
        # all ranks share standard error, so a second rank that writes would be seen there
        result = mpirun(2, *PLATE, "--json", "-", "--output", self.path("p.vtu"), "--state",
                        "/dev/stderr")
        self.assertEqual(result.returncode, 0, result.stderr)
        several = json.loads(result.stdout)
        self.assertEqual((several["ranks"], several["state_digest"]),
                         (2, record(*PLATE)["state_digest"]))
        self.assertEqual(os.listdir(self.directory), ["p.vtu"])
        self.assertEqual((result.stderr.count("element,"), result.stderr.count("\n")), (1, 1 + 144))

    def test_other_ranks_than_mpirun_started_are_refused(self):
        result = mpirun(2, *PLATE, "--ranks", "3")
        self.assertEqual((result.returncode, result.stdout), (2, ""), result.stderr)
        lines = set(own_lines(result))  # a second rank says the same if mpirun is slow to end it
        self.assertEqual(len(lines), 1, result.stderr)
        self.assertIn("this job has 2; give --ranks 2", lines.pop())


@unittest.skipIf(WHY_NOT, WHY_NOT)
class Failures(ProgramTest):
    def setUp(self):
        super().setUp()
        self.addCleanup(self.end_processes)

    def end_processes(self):
        for process in processes(self.directory):
            os.kill(process, signal.SIGKILL)

    def start(self, name, fault=None):
        """Starts an endless job of 2 ranks with this name on its command line.

        It writes NAME_0000.vtu when all ranks are about to compute.
        """
        environment = {**os.environ, **({"DSSBENCH_FAULT": fault} if fault else {})}
        job = subprocess.Popen([
            PROGRAM, *ENDLESS, "--ranks", "2", "--halo", "deep", "--output",
            self.path(name + ".vtu"), "--frames", "1"
        ], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment)
        self.addCleanup(lambda: (job.kill(), job.wait(), job.stdout.close(), job.stderr.close()))
        return job

    def wait_for(self, condition, what, limit_s):
        end = time.monotonic() + limit_s
        while not condition():
            self.assertLess(time.monotonic(), end, what)
            time.sleep(0.05)

    def rank_process(self, name, rank):
        """The process of one rank of a job that computes."""
        self.wait_for(lambda: os.path.exists(self.path(name + "_0000.vtu")),
                      f"{name} does not start", 30)
        mark = f"OMPI_COMM_WORLD_RANK={rank}\0".encode()
        return next(process for process, environment in processes(self.path(name)).items()
                    if mark in environment)

    def assert_ended(self, name, job, begin, *words):
        """The job has ended in time, with one line of error, and with all of its processes."""
        # A job that has both cores needs 10 s. Here other jobs and tests share the cores.
        output, error = job.communicate(timeout=max(0.1, begin + 12 - time.monotonic()))
        self.assertEqual((job.returncode, output, error.count("\n")), (1, "", 1), error)
        for word in ("rank 1 of 2", *words):
            self.assertIn(word, error)
        self.wait_for(lambda: not processes(self.path(name)), f"{name} leaves processes", 1)

    def test_a_rank_that_dies_hangs_or_is_stopped_ends_the_job_which_names_it(self):
        stopped = self.start("stopped")
        os.kill(self.rank_process("stopped", 1), signal.SIGSTOP)
        begin = time.monotonic()
        hangs = self.start("hangs", "hang:1:50")  # both at once: most of the time they only wait
        dies = self.start("dies", "die:1:50")
        self.assert_ended("dies", dies, begin, "signal 9")
        self.assert_ended("stopped", stopped, begin, "has not answered", "rank 0 waits for it")
        self.assert_ended("hangs", hangs, begin, "has not answered", "rank 0 waits for it")

    def test_ranks_end_with_a_launcher_that_is_killed(self):
        job = self.start("killed")
        self.rank_process("killed", 1)
        self.assertEqual(len(processes(self.path("killed"))), 4)  # launcher, mpirun, two ranks
        job.kill()
        self.wait_for(lambda: not processes(self.path("killed")),
                      "processes outlive their launcher", 2)


if __name__ == "__main__":
    unittest.main()
