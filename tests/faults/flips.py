#!/usr/bin/env python3
"""Flips bits of the state of runs at random, and counts which the guard and the energy find.

    make flips                                            # 1,000 flips
    tests/faults/flips.py PROGRAM --flips 12 [--seed 1]   # a short form

Each run has a random shipped scene (of a small size), method, precision, variant and guard. A flip
counts if the state at the guard's next look has other bits. With `--guard-steps` of all steps the
guard must find each of these. A run without a flip must have no report. Exit code 1 if one is
missed, or if there is a false report. The table also has what the guard finds if it computes one
step of each interval once more, for a bit that flips once and for one that stays wrong, and what
is found without a guard: by the energy, or since short runs are computed twice for it.
"""
import argparse
import collections
import json
import os
import random
import subprocess
import sys

from restarts import METHODS, PRECISIONS, SCENES, UNSTABLE

FAULTY_WORD = "a processor or memory may be faulty"
BITS = {"f64": 64, "f32": 32, "f32c": 32}
HALF_VELOCITIES = range(13, 19)  # variants/api/kept_state.hpp
STAGGERED = {"velocity_verlet", "smoothed_verlet"}


class Campaign:
    """Flips, and what was found of them."""

    def __init__(self, program, seed):
        self.program = program
        self.random = random.Random(seed)
        self.counts = collections.Counter()
        self.failures = []
        listed = json.loads(subprocess.run([program, "list", "variants", "--json"], check=True,
                                           capture_output=True, text=True).stdout)
        usable = {row["variant"] for row in listed if row["status"] == "usable"}
        self.variants = [name for name in ("avx2", "avx512", "scalar") if name in usable]

    def run(self, options, *more, flip=None):
        """(exit code, digest of the end or None, errors)."""
        environment = {**os.environ, **({"DSSBENCH_FLIP": flip} if flip else {})}
        result = subprocess.run([self.program, "run", *options, *more, "--json", "-"],
                                capture_output=True, text=True, timeout=300, env=environment)
        if result.returncode == 2:
            self.fail(f"a run was refused: {options} {more} {flip}: {result.stderr}")
        digest = json.loads(result.stdout)["state_digest"] if result.returncode in (0, 1) else None
        return result.returncode, digest, result.stderr

    def problem(self):
        """Options of a run, its precision and method."""
        scene, _ = self.random.choice(SCENES)
        method = self.random.choice(METHODS)
        precision = self.random.choice(PRECISIONS)
        options = [*scene, "--integrator", method, "--precision", precision,
                   "--variant", self.random.choice(self.variants)]
        if self.random.random() < 0.6:
            options += ["--model", "spatial"]
        return options, method, precision

    def elements(self, options):
        """Number of elements of the scene."""
        explained = subprocess.run([self.program, "run", *options, "--steps", "1", "--json", "-"],
                                   capture_output=True, text=True, timeout=300)
        return json.loads(explained.stdout)["elements"] if explained.returncode == 0 else 0

    def one(self):
        """One flip, seen by each guard."""
        options, method, precision = self.problem()
        every = self.random.randint(5, 40)
        steps = self.random.randint(2 * every, 4 * every)
        elements = self.elements(options)
        code, _, errors = self.run(options, "--steps", str(steps), "--guard", str(every),
                                   "--guard-steps", str(self.random.randint(1, every)))
        if FAULTY_WORD in errors:
            self.fail(f"a false report: {options}: {errors}")
            return
        if elements == 0 or code != 0:  # unstable, or the step is too long for the energy
            self.counts["left out"] += 1
            return
        self.counts["runs without a report"] += 1
        numbers = [*range(13), *(HALF_VELOCITIES if method in STAGGERED else [])]
        step = self.random.randint(0, steps - 1)
        flip = (f"{step}:{self.random.randrange(elements)}:{self.random.choice(numbers)}:"
                f"{self.random.randrange(BITS[precision])}")
        look = min((step // every + 1) * every, steps)
        _, flipped, _ = self.run(options, "--steps", str(look), flip=flip)
        _, clean, _ = self.run(options, "--steps", str(look))
        if flipped == clean:
            self.counts["flips that left no trace"] += 1
            return
        self.counts["flips"] += 1
        if not self.finds(options, steps, every, every, flip):
            self.fail(f"a flip was not found: DSSBENCH_FLIP={flip} {options} --steps {steps} "
                      f"--guard {every} --guard-steps {every}")
            return
        self.counts["found, all steps computed twice"] += 1
        self.counts["found, one step of each interval"] += self.finds(options, steps, every, 1,
                                                                      flip)
        self.counts["found without a guard"] += self.run(options, "--steps", str(steps),
                                                         flip=flip)[0] != 0
        self.counts["bits that stay wrong: found, one step of each interval"] += self.finds(
            options, steps, every, 1, flip + ":stays")

    def finds(self, options, steps, every, checked, flip):
        """The guard reports."""
        code, _, errors = self.run(options, "--steps", str(steps), "--guard", str(every),
                                   "--guard-steps", str(checked), "--no-balance", flip=flip)
        return code == 1 and FAULTY_WORD in errors

    def fail(self, line):
        self.failures.append(line)
        print(line.strip()[:400])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("program")
    parser.add_argument("--flips", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    campaign = Campaign(arguments.program, arguments.seed)
    while campaign.counts["flips"] < arguments.flips and not campaign.failures:
        campaign.one()
    for name, count in sorted(campaign.counts.items()):
        print(f"{count:7d}  {name}")
    print(f"{len(campaign.failures):7d}  failures")
    return 1 if campaign.failures else 0


if __name__ == "__main__":
    sys.exit(main())
