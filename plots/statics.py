#!/usr/bin/python3
"""States of rest by every solver: what they take, and how far they are from Newton's state.

Reads results/tables/statics.csv, as `dssbench experiment statics` writes it, and nothing else.
Left: time of a solution over the number of elements, at full loads. Right: difference of displacements against time; full: at full loads, open: at loads small enough for linear equations. Dashed:
the bar, which linear equations at full loads (crosses) need not meet.
Example: plots/statics.py results/tables/statics.csv --output results/figures/statics.png
"""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import pandas  # noqa: E402
from picture_command import draw_from_command_line  # noqa: E402
from report.pictures import measured_by, save  # noqa: E402

COLOURS = ["#000000", "#0072B2", "#56B4E9", "#009E73", "#E69F00", "#D55E00", "#CC79A7"]  # Okabe and Ito's
LEAST = 1e-16  # a difference below it is drawn there


def draw_times(axes, rows, colours):
    """Full loads alone: those of small loads take as long."""
    for solver, points in rows[rows["loads"] == 1].groupby("solver", sort=False):
        axes.scatter(points["elements"], points["wall_s"], color=colours[solver], s=28, label=solver, zorder=3)
    axes.set_xlabel("elements")
    axes.set_ylabel("time of a solution, s")


def draw_differences(axes, rows, colours):
    rows = rows[rows["solver"] != "newton"]
    for solver, points in rows.groupby("solver", sort=False):
        for marker, fill, chosen in (("o", colours[solver], (points["loads"] == 1) & (points["status"] != "linear")), ("o", "none", points["loads"] != 1), ("x", colours[solver], points["status"] == "linear")):
            some = points[chosen]
            edge = {} if marker == "x" else {"edgecolors": colours[solver]}
            axes.scatter(some["wall_s"], some["difference"].clip(lower=LEAST), marker=marker, c=fill, s=28, zorder=3, **edge)
    axes.axhline(rows["bar"].max(), color="black", linewidth=0.9, linestyle="--")
    axes.set_xlabel("time of a solution, s")
    axes.set_ylabel("displacements: largest difference to Newton's")


def draw(path, output):
    """Writes the figure; returns a line that says why there is none, or None."""
    table = pandas.read_csv(path)
    if not {"loads", "difference", "cg_iterations"} <= set(table.columns) or table.empty:
        return f"{path}: no states of rest"
    rows = table.dropna(subset=["wall_s", "difference"])
    colours = dict(zip(rows["solver"].unique(), COLOURS))
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.2), layout="constrained")
    draw_times(axes[0], rows, colours)
    draw_differences(axes[1], rows, colours)
    for axis in axes:
        axis.set_xscale("log")
        axis.set_yscale("log")
        axis.grid(alpha=0.3)
        axis.spines[["top", "right"]].set_visible(False)
    axes[0].legend(frameon=False, fontsize=8)
    failed = int((table["status"] == "failed").sum())
    axes[1].set_title("all within the bar" if failed == 0 else f"{failed} FAILED", fontsize=9, loc="left")
    output.parent.mkdir(parents=True, exist_ok=True)
    save(figure, output, measured_by(path), dpi=150)
    plt.close(figure)
    return None


if __name__ == "__main__":
    draw_from_command_line(__doc__, draw, "statics")
