"""The command line that pictures of one table share."""
import argparse
import pathlib
import sys


def draw_from_command_line(description, draw, experiment=""):
    """Draws the table and the picture that the command line names; draw(table, picture) says why it cannot, or nothing."""
    parser = argparse.ArgumentParser(description=description.splitlines()[0])
    parser.add_argument("table", type=pathlib.Path, help=f"results/tables/{experiment or 'NAME'}.csv")
    parser.add_argument("--output", type=pathlib.Path, required=True, help="PNG, SVG or PDF")
    arguments = parser.parse_args()
    if not arguments.table.exists():
        sys.exit(f"{arguments.table}: no such file; run `{' '.join(['dssbench experiment', experiment]).rstrip()}` first")
    reason = draw(arguments.table, arguments.output)
    if reason:
        sys.exit(reason)
    print(arguments.output)
