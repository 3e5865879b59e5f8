#!/usr/bin/env python3
"""Kills and stops the program, lets its writes fail, and counts what was lost or wrong.

    make faults                                      # 1,000 kills, 10,000 failed writes
    tests/faults/campaign.py PROGRAM LIBRARY --kills 6 --writes 40     # a short form

Kinds of fault:
  kills    kill -9 of a study, or of the process that measures, at a random moment; then --resume
  writes   the n-th call that changes a file fails (failing_calls.c), for every n in turn; by turns
           the disk is full (ENOSPC), the device is broken (EIO), the directory is read-only (EROFS)
  checkpoints  the same while a run writes checkpoints; then it is continued
  torn     a file of results is cut off at any length, then read
  gone     the directory of results vanishes while a study runs
  stopped  a study and all that it started stand still for a while (SIGSTOP)
  clock    the time of day jumps back and forth by a day
After each fault the study is resumed. `lost`: a record that was written before the fault is missing
or changed, or the study cannot be completed. `wrong`: a record that differs from an undisturbed
run's, a repetition twice, a crash, or a failure at exit code 0. Exit code 1 if there is any.
"""
import argparse
import collections
import csv
import errno
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

STUDY = {
    "experiment": "tiny", "title": "A tiny study",
    "cells": [{"scene": "plate_paper", "set": {"n": [8]}, "variants": ["scalar"], "threads": [1]},
              {"scene": "two_elements", "variants": ["scalar"], "threads": [1]}],
    "base": ["scalar"],
    "scales": {"smoke": {"steps": 20, "oracle_steps": 5, "repetitions": [3, 3], "retries": 0,
                         "budget_s": 60, "time_limit_s": 20}},
}
SCENE = ("run", "two_elements", "--variant", "scalar", "--steps", "20")
STEPS = 60
LONGER = ("run", "plate_paper", "--set", "n=8", "--variant", "scalar", "--steps", str(STEPS),
          "--no-balance", "--json", "-")
FAULTS = (errno.ENOSPC, errno.EIO, errno.EROFS)
CRASHES = (-signal.SIGSEGV, -signal.SIGABRT, -signal.SIGBUS, -signal.SIGFPE, -signal.SIGILL)


class Campaign:
    """Faults, one after another, in directories of their own."""

    def __init__(self, program, library, seed, folder):
        self.program, self.library, self.folder = program, library, pathlib.Path(folder)
        self.random = random.Random(seed)
        self.counts = collections.Counter()
        self.study = self.folder / "tiny.json"
        self.study.write_text(json.dumps(STUDY))
        begin = time.monotonic()
        self.require(self.experiment(self.folder / "whole"), 0)
        self.whole_s = time.monotonic() - begin
        self.expected = {self.key(row): row["state_digest"] for row in self.rows("whole")}
        whole = self.longer()
        self.require(whole, 0)
        self.digest = self.digest_of(whole)

    @staticmethod
    def key(row):
        return row["cell"], row["repetition"]

    @staticmethod
    def require(result, code):
        if result.returncode != code:
            sys.exit(f"campaign.py: exit code {result.returncode}: {result.stderr}")

    def command(self, out, *options):
        return [self.program, "experiment", self.study, "--scale", "smoke", "--out", out, *options]

    def experiment(self, out, *options, **settings):
        return subprocess.run(self.command(out, *options), capture_output=True, text=True,
                              timeout=300, **settings)

    def rows(self, name):
        """Whole records; a torn last one is left out, as the program does."""
        path = self.folder / name / "raw" / "tiny.csv"
        if not path.exists():
            return []
        text = path.read_text()
        return list(csv.DictReader(text[:text.rfind("\n") + 1].splitlines()))

    def count(self, kind, is_wrong, is_lost=False):
        """Counts a fault. @return whether it is to be told"""
        is_bad = is_wrong or is_lost
        for what, is_so in (("tried", True), ("survived", not is_bad), ("wrong", is_wrong),
                            ("lost", is_lost)):
            self.counts[kind, what] += is_so
        return is_bad

    def judge(self, kind, name, before, result=None):
        """Resumes the study, and looks at what is there."""
        after = self.rows(name)
        resumed = self.experiment(self.folder / name, "--resume")
        is_refused, why = resumed.returncode == 2, resumed.stderr
        if is_refused:
            resumed = self.experiment(self.folder / name)
        finished = [row for row in self.rows(name) if row["status"] == "ok"]
        have = collections.Counter(self.key(row) for row in finished)
        is_wrong = (any(count > 1 for count in have.values())
                    or any(row["state_digest"] != self.expected.get(self.key(row))
                           for row in finished)
                    or (result is not None and result.returncode in CRASHES))
        is_lost = ((is_refused and bool(before)) or resumed.returncode != 0
                   or set(have) != set(self.expected)
                   or any(row not in after for row in before))
        if self.count(kind, is_wrong, is_lost):
            print(f"{kind} {name}: wrong {is_wrong}, lost {is_lost}\n{why}{resumed.stderr}"
                  f"{result.stderr if result is not None else ''}", flush=True)
        shutil.rmtree(self.folder / name, ignore_errors=True)

    def kill(self, number):
        name = f"kill{number}"
        run = subprocess.Popen(self.command(self.folder / name), stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
        time.sleep(self.random.uniform(0, self.whole_s))
        victim = run.pid
        if self.random.random() < 0.3:
            try:
                children = pathlib.Path(f"/proc/{victim}/task/{victim}/children").read_text()
                victim = int(self.random.choice(children.split()))
            except (OSError, IndexError):
                pass
        before = self.rows(name)
        try:
            os.kill(victim, signal.SIGKILL)
        except ProcessLookupError:
            pass
        run.wait()
        self.judge("kills", name, before)

    def failing(self, number, fault, **more):
        return {**os.environ, "LD_PRELOAD": self.library, "DSS_FAIL_AT": str(number),
                "DSS_FAIL_ERRNO": str(fault), **more}

    def calls(self, command):
        """The number of calls of a command that change files."""
        count = self.folder / "calls"
        subprocess.run(command, capture_output=True, env=self.failing(0, 0, DSS_FAIL_COUNT=count))
        numbers = [int(line) for line in count.read_text().split()]
        count.unlink()
        return max(numbers)

    def fail_study(self, number, fault):
        """Two records are there already; the n-th call of the resumed study fails."""
        name = f"write{number}-{fault}"
        self.require(self.experiment(self.folder / name, "--rounds", "1"), 0)
        before = self.rows(name)
        result = self.experiment(self.folder / name, "--resume", env=self.failing(number, fault))
        self.judge("writes", name, before, result)

    def fail_run(self, number, fault):
        """A run writes three files, of which earlier versions exist. They stay old together."""
        files = [self.folder / name for name in ("end.csv", "end.json", "end.vtu")]
        for file in files:
            file.write_text("earlier\n")
        options = ("--state", files[0], "--json", files[1], "--output", files[2])
        result = subprocess.run([self.program, *SCENE, *options], capture_output=True, text=True,
                                env=self.failing(number, fault))
        texts = [file.read_bytes() for file in files]
        is_new = [text != b"earlier\n" for text in texts]
        is_whole = ((not is_new[0] or texts[0].endswith(b"\n"))
                    and (not is_new[1] or texts[1].rstrip().endswith(b"}"))
                    and (not is_new[2] or texts[2].rstrip().endswith(b"</VTKFile>")))
        parts = [path for path in self.folder.iterdir() if path.name.endswith(".part")]
        is_wrong = (not is_whole or result.returncode in CRASHES or bool(parts)
                    or len(set(is_new)) > 1 or (result.returncode == 0) != all(is_new)
                    or (result.returncode != 0 and result.stderr.count("\n") != 1))
        if self.count("outputs", is_wrong):
            print(f"outputs: call {number} fails with {fault}: exit code {result.returncode}, new "
                  f"{is_new}, whole {is_whole}, {parts}: {result.stderr}", flush=True)
        for path in files + parts:
            path.unlink()

    def longer(self, *options, **settings):
        return subprocess.run([self.program, *LONGER, *options], capture_output=True, text=True,
                              timeout=300, **settings)

    @staticmethod
    def digest_of(result):
        return json.loads(result.stdout)["state_digest"] if result.returncode == 0 else None

    def fail_checkpoint(self, number, fault):
        """What a run has left of its checkpoints continues to the state of a whole run."""
        saved = self.folder / "c.ckpt"
        files = [saved, saved.with_name("c.ckpt.previous")]
        first = self.longer("--checkpoint", saved, "--checkpoint-every", "20",
                            env=self.failing(number, fault))
        left = [file for file in files if file.exists()]
        parts = list(self.folder.glob("c.ckpt*.part"))
        ends = [self.longer("--restart", file) for file in left]
        digests = [self.digest_of(end) for end in ends if "has done all of its" not in end.stderr]
        is_wrong = (any(digest not in (self.digest, None)
                        for digest in [self.digest_of(first), *digests])
                    or any(run.returncode in CRASHES for run in [first, *ends])
                    or any(end.returncode == 2 and end.stderr.count("\n") != 1 for end in ends)
                    or bool(parts))
        # One call fails, so a run that goes on saves the next time.
        is_lost = ((bool(digests) and self.digest not in digests)
                   or (first.returncode == 0 and not saved.exists()))
        if self.count("checkpoints", is_wrong, is_lost):
            print(f"checkpoints: call {number} fails with {fault}: exit code {first.returncode}, "
                  f"left {[file.name for file in left + parts]}, digests {digests} of "
                  f"{self.digest}: {first.stderr}{''.join(end.stderr for end in ends)}", flush=True)
        self.remove_checkpoints()

    def remove_checkpoints(self):
        for path in self.folder.glob("c.ckpt*"):
            path.unlink()

    def survive(self, kind, result, name):
        """The study must end with the records of an undisturbed run."""
        have = {self.key(row): row["state_digest"] for row in self.rows(name)
                if row["status"] == "ok"}
        days = {row["time_utc"][:10] for row in self.rows(name)}
        is_wrong = (result.returncode != 0 or have != self.expected
                    or (kind == "clock" and len(days) < 2))  # else the clock did not jump
        if self.count(kind, is_wrong):
            print(f"{kind} {name}: exit code {result.returncode}: {result.stderr}", flush=True)
        shutil.rmtree(self.folder / name, ignore_errors=True)

    def stop(self, number):
        name = f"stopped{number}"
        run = subprocess.Popen(self.command(self.folder / name), stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE, text=True, start_new_session=True)
        time.sleep(self.random.uniform(0, self.whole_s))
        try:
            os.killpg(run.pid, signal.SIGSTOP)
            time.sleep(0.5)
        except ProcessLookupError:
            pass
        finally:
            if run.poll() is None:
                os.killpg(run.pid, signal.SIGCONT)
        errors = run.communicate(timeout=300)[1]
        self.survive("stopped", subprocess.CompletedProcess([], run.returncode, "", errors), name)

    def jump(self, number):
        name = f"clock{number}"
        jump = self.random.choice(["86400", "-86400"])
        environment = self.failing(0, 0, DSS_CLOCK_JUMP=jump)
        self.survive("clock", self.experiment(self.folder / name, env=environment), name)

    def tear(self, number):
        """A file of results that ends anywhere is refused in one line, or read up to there."""
        source = self.random.choice(["raw/tiny.csv", "raw/tiny.json", "tables/tiny.csv"])
        name = f"torn{number}"
        shutil.copytree(self.folder / "whole", self.folder / name)
        path = self.folder / name / source
        whole = path.read_bytes()
        path.write_bytes(whole[:self.random.randrange(len(whole))])
        result = self.experiment(self.folder / name, "--resume")
        rows = self.rows(name)
        is_wrong = (result.returncode not in (0, 2)
                    or (result.returncode == 2 and result.stderr.count("\n") != 1)
                    or any(row["state_digest"] != self.expected.get(self.key(row))
                           for row in rows if row["status"] == "ok")
                    or (result.returncode == 0 and len(rows) != len(self.expected)))
        if self.count("torn", is_wrong):
            print(f"torn: {source} at {path.stat().st_size} of {len(whole)}: exit code "
                  f"{result.returncode}: {result.stderr}", flush=True)
        shutil.rmtree(self.folder / name)

    def vanish(self, number):
        """The directory of results is removed while the study runs."""
        name = f"gone{number}"
        run = subprocess.Popen(self.command(self.folder / name), stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE, text=True)
        time.sleep(self.random.uniform(0, self.whole_s))
        shutil.rmtree(self.folder / name, ignore_errors=True)
        errors = run.communicate(timeout=300)[1].splitlines()
        has_all = len(self.rows(name)) == len(self.expected)
        is_wrong = run.returncode in CRASHES or (run.returncode == 0 and not has_all
                                                 and (self.folder / name).exists())
        if self.count("gone", is_wrong):
            print(f"gone: exit code {run.returncode}: {errors}", flush=True)
        shutil.rmtree(self.folder / name, ignore_errors=True)

    def run(self, kills, writes):
        for number in range(kills):
            self.kill(number)
            self.tear(number)
            if number % 4 == 0:
                self.vanish(number)
                self.stop(number)
                self.jump(number)
        files = [self.folder / name for name in ("a.csv", "a.json", "a.vtu")]
        most = self.calls([self.program, *SCENE, "--state", files[0], "--json", files[1],
                           "--output", files[2]])
        of_run = min(len(FAULTS) * most, writes // 2)
        for place in range(of_run):
            self.fail_run(1 + place % most, FAULTS[place // most])
        saving = ("--checkpoint", self.folder / "c.ckpt", "--checkpoint-every", "20")
        most = self.calls([self.program, *LONGER, *saving])
        self.remove_checkpoints()
        of_checkpoints = min(len(FAULTS) * most, writes // 4)
        for place in range(of_checkpoints):  # spread over all calls
            turn, call = divmod(place * len(FAULTS) * most // of_checkpoints, most)
            self.fail_checkpoint(1 + call, FAULTS[(turn + call) % len(FAULTS)])
        most = self.calls(self.command(self.folder / "counted"))
        for place in range(writes - of_run - of_checkpoints):
            self.fail_study(1 + place % most, FAULTS[(place // most + place) % len(FAULTS)])


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("library", help="failing_calls as a shared library")
    parser.add_argument("--kills", type=int, default=1000)
    parser.add_argument("--writes", type=int, default=10000)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="dssbench-faults-") as folder:
        campaign = Campaign(arguments.program, arguments.library, arguments.seed, folder)
        campaign.run(arguments.kills, arguments.writes)
    kinds = sorted({kind for kind, _ in campaign.counts})
    for kind in kinds:
        print(f"{kind}: " + ", ".join(f"{what} {campaign.counts[kind, what]}"
                                      for what in ("tried", "survived", "lost", "wrong")))
    bad = sum(count for (_, what), count in campaign.counts.items() if what in ("lost", "wrong"))
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
