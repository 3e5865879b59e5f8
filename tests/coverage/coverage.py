#!/usr/bin/env python3
"""Prints which share of lines and branches the tests ran, by folder, and the files with least.

    make coverage

It reads what a build of the preset `coverage` counted, with gcovr. BUILD/coverage/index.html shows
each line. Branches that only exceptions take are left out.
"""
import argparse
import collections
import json
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
PRODUCT = ["kernels", "solver", "variants", "experiments"]
COLUMNS = ["folder", "lines", "lines_run_pct", "branches", "branches_run_pct"]


def measured(build):
    """gcovr's summary of each file."""
    page = build / "coverage"
    page.mkdir(exist_ok=True)
    summary = page / "summary.json"
    filters = [f"--filter={ROOT}/{folder}/" for folder in PRODUCT]
    subprocess.run(["gcovr", f"--root={ROOT}", "-j", "2", "--exclude-throw-branches",
                    "--exclude-unreachable-branches", "--gcov-ignore-parse-errors", *filters,
                    "--json-summary", summary, "--html-details", page / "index.html", build],
                   check=True)
    return [file for file in json.loads(summary.read_text())["files"] if file["line_total"]]


def share(covered, total):
    return round(100 * covered / total, 1) if total else 100.0


def row(name, files):
    total = {key: sum(f[key] for f in files)
             for key in ("line_total", "line_covered", "branch_total", "branch_covered")}
    return [name, total["line_total"], share(total["line_covered"], total["line_total"]),
            total["branch_total"], share(total["branch_covered"], total["branch_total"])]


def by_folder(files):
    """A row for each folder of two levels, and one for all."""
    folders = collections.defaultdict(list)
    for file in files:
        folders["/".join(pathlib.PurePath(file["filename"]).parent.parts[:2])].append(file)
    return [row(name, folders[name]) for name in sorted(folders)] + [row("all", files)]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    files = measured(parser.parse_args().build.resolve())
    table = by_folder(files)
    for folder, *figures in [COLUMNS, *table]:
        print(f"{folder:32}" + "".join(f"{figure:>18}" for figure in figures))
    print("\nfiles of which least is run:")
    for file in sorted(files, key=lambda f: f["line_percent"])[:12]:
        print(f"{file['line_percent']:6.1f} % of {file['line_total']:4} lines  {file['filename']}")


if __name__ == "__main__":
    main()
