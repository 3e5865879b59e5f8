#!/usr/bin/python3
"""Draws all figures of a directory of results: charts of its tables and pictures of its bodies.

The command reads DIR/tables, DIR/raw and DIR/fields, and writes DIR/figures. No solver runs. Every
figure is checked. An unreadable figure is an error, which is reported after all are drawn.
Example: plots/make_plots.py --results results
"""
import argparse
import functools
import pathlib
import sys

import body_picture
from charts import figures_of
from render import pictures, png
from render.check import Unreadable
from tables.results import FAULTS, NotMeasured, Results


def draw_figure(results, entries, output):
    """Draws the charts that share a figure. @returns lines: the file, or why there is none"""
    charts, reasons = [], []
    for entry in entries:
        try:
            charts.append(entry.make(results))
        except NotMeasured as reason:
            reasons.append(f"{output.name}: {reason}")
    if not charts:
        return list(dict.fromkeys(reasons))
    png.draw(charts, output, pictures.measured_by(results.directory, entries[0].table))
    return [output]


def draw_all(results, table=None):
    """Draws all figures, or those of one table. @returns the errors"""
    figures, errors = results.directory / "figures", []
    jobs = []
    for name, entries in figures_of(results).items():
        output = figures / f"{name}.png"
        if table in (None, entries[0].table):
            jobs.append((output, functools.partial(draw_figure, results, entries, output)))
    if table is None:
        jobs += body_picture.pictures_of(results.directory / "fields", figures)
    for output, draw in jobs:
        try:
            print(*draw(), sep="\n")
        except Unreadable as fault:
            errors.append(str(fault))
        except FAULTS as fault:
            errors.append(f"{output} cannot be drawn: {type(fault).__name__}: {fault}")
    return errors


def main():
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--results", type=pathlib.Path, default=pathlib.Path("results"),
                        help="directory with tables/ and fields/")
    parser.add_argument("--table", help="only the figures of tables/TABLE.csv")
    arguments = parser.parse_args()
    results = Results(arguments.results)
    if not results.names() and not any((results.directory / "fields").glob("*.vtu")):
        sys.exit(f"{results.directory}: no tables/*.csv and no fields/*.vtu; "
                 "run `dssbench experiment` first")
    errors = draw_all(results, arguments.table)
    if errors:
        sys.exit("\n".join(errors))


if __name__ == "__main__":
    main()
