#!/usr/bin/env python3
"""Runs the fuzz targets of a build, and counts what they executed.

    make fuzz                  # 60 s a reader
    make fuzz FUZZ_S=3600      # an hour each

Seeds are the shipped files of each kind and tests/fuzz/seeds/NAME. What libFuzzer finds new goes to
BUILD/corpus/NAME and is used again. A crash, a leak, an input that takes 10 s or an allocation of
1 GB stops the target; its input is kept in BUILD/corpus, and the exit code is 1.
"""
import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SHIPPED = {
    "json": ["experiments/scenes/**/*.json"],
    "scene": ["experiments/scenes/**/*.json"],
    "platform": ["experiments/platforms/*.xml"],
    "study": ["experiments/studies/**/*.json"],
    "members": ["examples/ensemble/*"],
    "csv": ["results/raw/table2.csv", "examples/ensemble/*.csv"],
    "surface": ["experiments/scenes/verification/*.stl"],
}
LIMITS = ["-timeout=10", "-rss_limit_mb=2048", "-malloc_limit_mb=1024", "-print_final_stats=1"]


def seeds_of(name, folder):
    """Copies the shipped files of a kind into a folder of seeds. Large ones would slow it down."""
    for pattern in SHIPPED.get(name, []):
        for number, path in enumerate(sorted(ROOT.glob(pattern))):
            (folder / f"{number}-{path.name}").write_bytes(path.read_bytes()[:20000])
    return folder


def run_target(program, build, seconds):
    """Executions of one target, and whether it found nothing."""
    name = program.name.removesuffix("_fuzz")
    corpus = build / "corpus" / name
    corpus.mkdir(parents=True, exist_ok=True)
    own = ROOT / "tests" / "fuzz" / "seeds" / name
    in_memory = "/dev/shm" if os.path.isdir("/dev/shm") else None  # what targets write
    with tempfile.TemporaryDirectory(prefix="dssbench-seeds-") as folder, \
            tempfile.TemporaryDirectory(prefix="dssbench-fuzz-", dir=in_memory) as written:
        seeds = [seeds_of(name, pathlib.Path(folder))] + ([own] if own.is_dir() else [])
        environment = {**os.environ, "TMPDIR": written}
        result = subprocess.run(
            [program, f"-max_total_time={seconds}", f"-artifact_prefix={corpus}-", *LIMITS, corpus,
             *seeds], capture_output=True, text=True, errors="replace", env=environment)
    counted = re.search(r"number_of_executed_units: *(\d+)", result.stderr)
    executed = int(counted.group(1)) if counted else 0
    if result.returncode != 0:
        print("\n".join(result.stderr.splitlines()[-60:]), file=sys.stderr)
    print(f"{name}: {executed} executions, "
          f"{'nothing found' if result.returncode == 0 else 'FOUND, see above'}", flush=True)
    return executed, result.returncode == 0


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--seconds", type=int, default=60, help="time a target")
    parser.add_argument("--only", action="append", help="targets, such as json (default: all)")
    arguments = parser.parse_args()
    programs = sorted(path for path in arguments.build.glob("tests/fuzz/*_fuzz")
                      if os.access(path, os.X_OK))
    chosen = [p for p in programs
              if not arguments.only or p.name.removesuffix("_fuzz") in arguments.only]
    if not chosen:
        sys.exit(f"fuzz.py: no such targets in {arguments.build}; build the preset fuzz")
    results = [run_target(p, arguments.build.resolve(), arguments.seconds) for p in chosen]
    print(f"{sum(executed for executed, _ in results)} executions in all")
    return 0 if all(is_fine for _, is_fine in results) else 1


if __name__ == "__main__":
    sys.exit(main())
