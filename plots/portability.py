#!/usr/bin/python3
"""Performance portability of the variants over several machines (Pennycook's metric).

Each FOLDER has results of one machine, as `make reproduce` or `dssbench experiment --out` leave
them. Prints a table; exit code 1 if there is nothing to compare.

Example: plots/portability.py results results/h100
"""
import argparse
import pathlib
import sys

from charts.portability import cascade_of
from render import png
from render.check import Unreadable
from tables import portability
from tables.results import NotMeasured


def printed(heads, lines):
    """A table of Markdown in columns of equal width."""
    widths = [max(map(len, column)) for column in zip(heads, *lines)]
    texts = [" | ".join(cell.ljust(width) for cell, width in zip(line, widths))
             for line in (heads, ["-" * width for width in widths], *lines)]
    return "\n".join(f"| {text} |" for text in texts)


def write(frame, options):
    """Writes the outputs that were asked for, none over a file of the folders."""
    outputs = [path for path in (options.csv, options.figure) if path]
    for path in outputs:
        if any(folder.resolve() in path.resolve().parents for folder in options.folders):
            raise NotMeasured(f"{path}: is in a folder of results; name a file outside")
        if not path.resolve().parent.is_dir():
            raise NotMeasured(f"{path}: there is no such folder")
    if options.figure:
        png.draw([cascade_of(frame, options.efficiency)], options.figure,
                 "commits " + ", ".join(dict.fromkeys(frame["commit"])))
    if options.csv:
        frame.to_csv(options.csv, index=False, lineterminator="\n")


def main():
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", type=pathlib.Path, metavar="FOLDER")
    parser.add_argument("--table", default="table3", help="a table of cells (default: table3)")
    parser.add_argument("--efficiency", choices=portability.KINDS, default="application",
                        help="over the fastest application, or over the roof of the platform")
    parser.add_argument("--csv", type=pathlib.Path, help="file for all efficiencies")
    parser.add_argument("--figure", type=pathlib.Path, help="file for the cascade plot (.png)")
    options = parser.parse_args()
    try:
        frame = portability.efficiencies(options.folders, options.table)
        write(frame, options)
    except (NotMeasured, Unreadable, OSError) as fault:
        sys.exit(f"portability.py: {fault}")
    print(printed(*portability.table_of(frame, options.efficiency)))


if __name__ == "__main__":
    main()
