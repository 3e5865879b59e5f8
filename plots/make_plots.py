#!/usr/bin/python3
"""All figures of a directory of results: a bar chart for each table, a picture for each .vtu in fields/.

Reads DIR/tables/*.csv and DIR/fields/*.vtu, writes DIR/figures/. With --program it first has dssbench make the field of the paper's
plate, if there is none; otherwise no solver runs.
Example: plots/make_plots.py --results results
"""
import argparse
import pathlib
import subprocess
import sys

import plate_picture
import speedup_bars


PLATE = ["run", "plate_paper", "--set", "n=60", "--steps", "2000"]


def make_plate(program, target):
    """Has the program write the plate's field, unless it is there."""
    if target.exists():
        return
    target.parent.mkdir(parents=True, exist_ok=True)
    subprocess.run([program, *PLATE, "--output", str(target)], check=True, stdout=subprocess.DEVNULL)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--results", type=pathlib.Path, default=pathlib.Path("results"), help="directory with tables/ and fields/")
    parser.add_argument("--program", help="dssbench, to make fields/plate_paper.vtu where it is missing")
    arguments = parser.parse_args()
    results = arguments.results
    if arguments.program:
        make_plate(arguments.program, results / "fields" / "plate_paper.vtu")
    tables, fields = sorted((results / "tables").glob("*.csv")), sorted((results / "fields").glob("*.vtu"))
    if not tables and not fields:
        sys.exit(f"{results}: no tables/*.csv and no fields/*.vtu; run `dssbench experiment` first")
    for table in tables:
        output = results / "figures" / f"{table.stem}.png"
        print(speedup_bars.draw(table, None, output) or output)
    for field in fields:
        output = results / "figures" / f"{field.stem}.png"
        plate_picture.draw(field, output, None)
        print(output)


if __name__ == "__main__":
    main()
