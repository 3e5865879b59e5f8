#!/usr/bin/env python3
"""Plants small mistakes into the sources one by one, and counts those that the tests find.

    make mutants                     # all areas of areas.json, a sample of each
    tests/mutants/mutate.py --tree build/mutants --area statistics --count 0   # all of one

It works on a copy of the tree, so that the sources never change. A mutant is killed if a test
fails, crashes or takes ten times as long; one that does not compile does not count. Survivors that
change nothing are listed in known.json with the reason. Exit code 1 if fewer than `--goal` of the
others are killed.
"""
import argparse
import collections
import json
import pathlib
import random
import signal
import subprocess
import sys
import time

from mutations import mutants_of

HERE = pathlib.Path(__file__).resolve().parent
SLOWER = 10


class Area:
    """Sources, and the tests that should notice a mistake in them: pairs of a program and a filter,
    the nearest first."""

    def __init__(self, name, description, tree, build):
        self.name, self.tree, self.build = name, tree, build
        self.tests = [tuple(test) for test in description["tests"]]
        self.files = sorted({str(path.relative_to(tree)) for pattern in description["files"]
                             for path in tree.glob(pattern)})

    def mutants(self):
        return [m for path in self.files for m in mutants_of(path, (self.tree / path).read_text())]

    def compile(self):
        targets = dict.fromkeys(target for target, _ in self.tests)
        return subprocess.run(["cmake", "--build", self.build, "--target", *targets],
                              capture_output=True, text=True).returncode == 0

    def program(self, target):
        return next(self.build.glob(f"tests/**/{target}"))

    def has(self, test):
        target, tests = test
        listed = subprocess.run([self.program(target), f"--gtest_filter={tests}",
                                 "--gtest_list_tests"], capture_output=True, text=True, check=True)
        return any(line.startswith("  ") for line in listed.stdout.splitlines())

    def passes(self, test, limit_s):
        """True if the tests of one program that match its filter pass in time."""
        target, tests = test
        try:
            command = [self.program(target), f"--gtest_filter={tests}", "--gtest_fail_fast"]
            return subprocess.run(command, capture_output=True, timeout=limit_s).returncode == 0
        except subprocess.TimeoutExpired:
            return False

    def prepare(self):
        """Builds and times the tests without a mistake."""
        if not self.compile():
            sys.exit(f"mutate.py: {self.name}: does not build without a mutant")
        self.limits = {}
        for test in self.tests:
            if not self.has(test):
                sys.exit(f"mutate.py: {self.name}: {' '.join(test)} matches no test")
            begin = time.monotonic()
            if not self.passes(test, 3600):
                sys.exit(f"mutate.py: {self.name}: {' '.join(test)} fails without a mutant")
            self.limits[test] = 5 + SLOWER * (time.monotonic() - begin)

    def judged(self, mutant):
        """killed, survived or invalid"""
        path = self.tree / mutant.path
        text = path.read_text()
        try:
            path.write_text(mutant.applied_to(text))
            if not self.compile():
                return "invalid"
            passes = all(map(self.passes, self.tests, self.limits.values()))
            return "survived" if passes else "killed"
        finally:
            path.write_text(text)


def judge_area(area, chosen, known):
    """Counts by verdict, and the survivors that are not known."""
    area.prepare()
    counts, survivors = collections.Counter(), []
    for place, mutant in enumerate(chosen, 1):
        verdict = "known" if mutant.key() in known else area.judged(mutant)
        counts[verdict] += 1
        if verdict == "survived":
            survivors.append(mutant.name())
            print(f"survived: {mutant.name()}", flush=True)
        if place % 20 == 0:
            print(f"{area.name}: {place} of {len(chosen)}: {dict(counts)}", flush=True)
    return counts, survivors


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tree", type=pathlib.Path, required=True, help="a copy of the sources")
    parser.add_argument("--build", type=pathlib.Path, help="default: TREE/build/debug")
    parser.add_argument("--area", action="append", help="areas of areas.json (default: all)")
    parser.add_argument("--count", type=int, default=60, help="mutants an area; 0: all")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--goal", type=float, default=0.95)
    parser.add_argument("--json", type=pathlib.Path, help="file for the result")
    arguments = parser.parse_args()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # a mutant is taken back first
    tree = arguments.tree.resolve()
    build = (arguments.build or tree / "build" / "debug").resolve()
    areas = json.loads((HERE / "areas.json").read_text())
    known = json.loads((HERE / "known.json").read_text())
    result, is_met = {}, True
    for name in arguments.area or areas:
        area = Area(name, areas[name], tree, build)
        every = area.mutants()
        count = min(arguments.count or len(every), len(every))
        chosen = random.Random(arguments.seed).sample(every, count)
        counts, survivors = judge_area(area, chosen, known)
        judged = counts["killed"] + counts["survived"]
        share = counts["killed"] / judged if judged else 1
        is_met = is_met and share >= arguments.goal
        print(f"{name}: {counts['killed']} of {judged} killed ({100 * share:.0f} %), "
              f"{counts['known']} known to change nothing, {counts['invalid']} do not compile; "
              f"{count} of {len(every)} tried")
        result[name] = {**counts, "mutants": len(every), "survivors": survivors}
        if arguments.json:
            arguments.json.write_text(json.dumps(result, indent=1) + "\n")
    return 0 if is_met else 1


if __name__ == "__main__":
    sys.exit(main())
