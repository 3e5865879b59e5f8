#!/usr/bin/python3
"""Times of a table as JSON for services that follow benchmarks over commits.

The form is `customSmallerIsBetter` of github-action-benchmark, which others read as well: a list of
{name, unit, value, range, extra}. A row without an interval, or whose check failed, is left out.

Example: plots/continuous.py --results results --table table1 > times.json
"""
import argparse
import json
import pathlib
import sys

from tables.results import NotMeasured, Results, is_pair

COLUMNS = ("label", "experiment", "scene", "variant", "model", "precision", "integrator",
           "threads", "ranks", "steps", "measured_wall_s", "measured_wall_low_s",
           "measured_wall_high_s", "status")


def name_of(row):
    """What was measured, in words that stay the same from commit to commit."""
    words = [row["experiment"], row["scene"], row["set"], row["variant"], row["model"],
             row["precision"], row["integrator"], f"threads={row['threads']:.0f}",
             f"ranks={row['ranks']:.0f}", row["halo"]]
    return " ".join(str(word) for word in words if word == word)  # an empty value is not itself


def entry_of(row, extra):
    """The time of a step of one row."""
    steps = row["steps"]
    low, high = row["measured_wall_low_s"] / steps, row["measured_wall_high_s"] / steps
    value = row["measured_wall_s"] / steps
    return {"name": name_of(row), "unit": "s/step", "value": value,
            "range": f"{low:.6g} to {high:.6g}", "extra": extra}


def entries_of(results, table):
    """The entries of all rows that count, and how many were left out."""
    frame = Results(results).table(table, *COLUMNS, optional=("set", "halo"))
    raw = json.loads((results / "raw" / f"{table}.json").read_text(encoding="utf-8"))["context"]
    extra = f"commit {raw['git_commit']}, {raw['cpu_model']}"
    good = frame[(frame["status"] == "ok") & frame["measured_wall_low_s"].notna() & ~is_pair(frame)]
    return [entry_of(row, extra) for _, row in good.iterrows()], len(frame) - len(good)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--results", type=pathlib.Path, default=pathlib.Path("results"))
    parser.add_argument("--table", default="table1", help="a table of cells, such as table1")
    options = parser.parse_args()
    try:
        entries, left_out = entries_of(options.results, options.table)
    except (NotMeasured, OSError, LookupError) as fault:
        sys.exit(f"continuous.py: {options.results}, {options.table}: {fault}")
    json.dump(entries, sys.stdout, indent=1)
    print(f"{len(entries)} times, {left_out} rows left out", file=sys.stderr)


if __name__ == "__main__":
    main()
