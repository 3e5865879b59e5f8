#!/usr/bin/env python3
"""Interrupts runs at random, continues them elsewhere, and compares bits.

    make restarts                                       # 1,000 runs
    tests/faults/restarts.py PROGRAM --runs 24 [--seed 1]      # a short form

Each run has a random shipped scene (of a small size), method, precision, and number of threads and
ranks, on a random variant; some are ensembles. It is interrupted at a random step (its last
checkpoint but one), by kill -9, or by SIGTERM. Another random combination continues it. Its state
must have the bits of an uninterrupted run. Runs that no method can compute stably are left out and
counted. Exit code 1 if anything is wrong.
"""
import argparse
import collections
import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

# Small sizes: options, and steps of the run.
SCENES = [
    (("block", "--set", "nx=7", "--set", "ny=5", "--set", "nz=4"), 300),
    (("cantilever_beam", "--set", "n=12"), 600),
    (("chain", "--set", "n=33"), 600),
    (("l_bracket",), 300),
    (("plate_bending", "--set", "n=10"), 600),
    (("plate_paper", "--set", "n=17"), 600),
    (("tumbling_box",), 400),
    (("two_bodies",), 400),
    (("two_elements",), 1000),
]
SHIPPED = pathlib.Path(__file__).resolve().parents[2] / "experiments" / "scenes"
METHODS = ["rk4", "velocity_verlet", "smoothed_verlet", "midpoint", "symplectic_euler", "dopri5",
           "verner8", "rkc2"]
PRECISIONS = ["f64", "f32", "f32c"]
UNSTABLE = 3
# Reasons why a combination cannot run at all: not faults.
IMPOSSIBLE = ("rows for", "give at most that", "take at most", "a watched model")


class Restarts:
    """Runs, one after another, in a directory of their own."""

    def __init__(self, program, seed, folder):
        self.program, self.folder = program, pathlib.Path(folder)
        self.random = random.Random(seed)
        self.counts = collections.Counter()
        listed = json.loads(subprocess.run([program, "list", "variants", "--json"], check=True,
                                           capture_output=True, text=True).stdout)
        usable = {row["variant"] for row in listed if row["status"] == "usable"}
        self.variants = [name for name in ("avx2", "avx512", "opencl", "hybrid") if name in usable]
        if not self.variants:
            sys.exit("restarts.py: no variant with fused multiply-add is usable")
        self.has_ranks = "mpi" in usable

    def runner(self):
        """Options that must not change bits."""
        variant = self.random.choice(self.variants)
        threads = str(self.random.randint(1, 3))
        if variant == "hybrid":
            members = [name for name in self.variants if name != "hybrid"]
            return ["--hybrid", ",".join(self.random.choice(members) + ":1" for _ in range(2))]
        options = ["--variant", variant, "--threads", threads]
        if self.has_ranks and variant.startswith("avx") and self.random.random() < 0.3:
            options += ["--ranks", str(self.random.randint(2, 3)), "--halo",
                        self.random.choice(["sendrecv", "overlap", "deep", "auto"])]
        return options

    def problem(self):
        """Options that decide bits."""
        scene, steps = self.random.choice(SCENES)
        method = self.random.choice(METHODS)
        # The scenes' steps suit rk4, whose limit is 1.4 times that of leapfrog methods.
        steps += self.random.randint(-50, 50)
        options = [*scene, "--steps", str(steps), "--integrator", method,
                   "--precision", self.random.choice(PRECISIONS)]
        if method == "dopri5" and self.random.random() < 0.7:
            options += ["--rtol", self.random.choice(["1e-4", "1e-6"])]
        if self.random.random() < 0.6:
            options += ["--model", "spatial"]
            if "--rtol" not in options and self.random.random() < 0.4:
                options += ["--ensemble", self.members(scene[0])]
        return options, steps

    def members(self, scene):
        """Equal members, or a file of members with steps of their own."""
        count = self.random.randint(1, 19)
        if self.random.random() < 0.3:
            return str(count)
        dt = json.loads((SHIPPED / f"{scene}.json").read_text(encoding="utf-8"))["run"]["dt"]
        factors = [round(self.random.uniform(0.5, 1), 6) for _ in range(count)]
        members = [{"set": {"run.dt": f"{dt}*{f}" if isinstance(dt, str) else dt * f}}
                   for f in factors]
        (self.folder / "members.json").write_text(json.dumps({"members": members}))
        return "members.json"

    def run(self, *options):
        return subprocess.run([self.program, "run", *options], capture_output=True, text=True,
                              timeout=300, cwd=self.folder)

    @staticmethod
    def digest(result):
        return json.loads(result.stdout)["state_digest"]

    @staticmethod
    def step_of(saved):
        return json.loads(saved.read_bytes().split(b"\n", 2)[1])["step"]

    def interrupt(self, arguments, kind, steps):
        """Runs until something ends it. @return the checkpoint to continue from, or None."""
        saved, earlier = self.folder / "c.ckpt", self.folder / "c.ckpt.previous"
        if kind == "step":
            return earlier if self.run(*arguments).returncode == 0 and earlier.exists() else None
        with subprocess.Popen([self.program, "run", *arguments], cwd=self.folder,
                              start_new_session=True, stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE, text=True) as process:
            end = time.monotonic() + self.random.uniform(0.05, 0.4)
            while time.monotonic() < end and process.poll() is None:
                time.sleep(0.005)
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL if kind == "kill" else signal.SIGTERM)
            line = process.communicate()[1]
        if process.returncode == 0:
            return earlier if earlier.exists() else None
        # After its last step a run still looks at its energy. Adaptive steps have other numbers.
        is_at_end = saved.exists() and (self.step_of(saved) == steps or "--rtol" in arguments)
        if kind == "signal" and saved.exists() and not is_at_end and "--restart" not in line:
            self.fail(arguments, f"no line says how to go on: {line}")
        return saved if saved.exists() else None

    def fail(self, arguments, what):
        self.counts["wrong"] += 1
        print(f"WRONG {' '.join(map(str, arguments))}: {what.strip()[:300]}")

    def is_left_out(self, result):
        is_so = result.returncode == UNSTABLE or any(word in result.stderr for word in IMPOSSIBLE)
        self.counts["left out"] += is_so
        return is_so

    def one(self):
        for file in self.folder.iterdir():
            file.unlink()
        problem, steps = self.problem()
        kind = self.random.choice(["step", "step", "kill", "signal"])
        runner = self.runner()
        # --model auto watches small models in one process alone, so it may choose others elsewhere.
        has_model = "--model" in problem
        whole = self.run(*problem, *(self.runner() if has_model else runner), "--no-balance",
                         "--json", "-")
        if whole.returncode != 0:
            if not self.is_left_out(whole):
                self.fail(problem, whole.stderr)
            return
        every = self.random.randint(1, max(1, steps // 2))
        first = [*problem, *runner, "--checkpoint", "c.ckpt", "--checkpoint-every",
                 str(every)]
        saved = self.interrupt(first, kind, steps)
        if saved is None:
            self.counts["ended before"] += 1
            return
        second = [*problem, *self.runner(), "--restart", saved.name, "--no-balance", "--json", "-"]
        again = self.run(*second)
        if again.returncode != 0 and "has done all of its" in again.stderr:
            self.counts["ended before"] += 1
        elif again.returncode != 0:
            if not self.is_left_out(again):
                self.fail([*first, "/", *second], again.stderr)
        elif self.digest(again) != self.digest(whole):
            self.fail([*first, "/", *second], f"{self.digest(again)}, not {self.digest(whole)}")
        else:
            of = "ensembles" if "--ensemble" in problem else "runs"
            self.counts[f"{of} continued after {kind}"] += 1


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--runs", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="dssbench-restarts-") as folder:
        restarts = Restarts(os.path.abspath(arguments.program), arguments.seed, folder)
        for _ in range(arguments.runs):
            restarts.one()
    counts = restarts.counts
    print(f"{arguments.runs} runs: {dict(sorted(counts.items()))}")
    is_empty = not any("continued" in key for key in counts)
    return 1 if counts["wrong"] or is_empty else 0


if __name__ == "__main__":
    sys.exit(main())
