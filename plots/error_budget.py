#!/usr/bin/python3
"""Error budget: the error of each source as a bar, a panel a scene, on one logarithmic axis.

Reads results/tables/error_budget.csv, as `dssbench experiment error_budget` writes it, and nothing else; never runs a solver.
Hatched: refinement has no limit, the bar is the difference between the first and the last grid. What could not be computed is named with its status.
Example: plots/error_budget.py results/tables/error_budget.csv --output results/figures/error_budget.png
"""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import pandas  # noqa: E402
from picture_command import draw_from_command_line  # noqa: E402
from report.pictures import measured_by, save  # noqa: E402

# Okabe and Ito's colours by kind of source.
COLOURS = {"time": "#0072B2", "space": "#D55E00", "rounding": "#009E73", "model": "#E69F00", "rotation": "#CC79A7"}
OTHER_COLOUR = "#999999"
LEAST = 1e-17  # bars begin here: an error of zero has none


def words(row):
    """Beside a bar: the error, and what must be known of it."""
    if pandas.isna(row["error"]):
        return str(row["status"])
    text = "none" if row["error"] == 0 else f"{row['error']:.1e}"
    if not pandas.isna(row["observed_order"]) and row["status"] == "ok":
        text += f"  (observed order {row['observed_order']:.2f})"
    return text if row["status"] == "ok" else f"{text}  ({row['status']})"


def draw_panel(axes, label, rows):
    """One scene."""
    rows = rows.iloc[::-1].reset_index(drop=True)
    for place, row in rows.iterrows():
        error = 0 if pandas.isna(row["error"]) else row["error"]
        bar = axes.barh(place, max(error - LEAST, 0), left=LEAST, color=COLOURS.get(row["source"].split()[0], OTHER_COLOUR))
        if row["status"] == "no limit":
            bar[0].set_hatch("//")
            bar[0].set_edgecolor("white")
        axes.annotate(words(row), (max(error, LEAST), place), xytext=(4, 0), textcoords="offset points", va="center", fontsize=8.5)
    steps = [f"{source} (dt = {dt:.3g} s)" if source.startswith("time") else source for source, dt in zip(rows["source"], rows["dt_s"])]
    axes.set_yticks(range(len(rows)), steps, fontsize=9)
    first = rows.iloc[0]
    axes.set_title(f"{label}: {first['integrator']}, {int(first['elements'])} elements, to {first['end_time_s']:g} s", fontsize=10, loc="left")
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(axis="x", alpha=0.25)
    axes.set_axisbelow(True)


def draw(path, output):
    """Writes the figure; returns a line that says why there is none, or None."""
    table = pandas.read_csv(path)
    if "source" not in table.columns or "observed_order" not in table.columns:
        return f"{path}: is no error budget; make one with `dssbench experiment error_budget`"
    if table["error"].notna().sum() == 0:
        return f"{path}: no error was found"
    groups = list(table.groupby("label", sort=False))
    heights = [len(rows) + 1.5 for _, rows in groups]
    figure, panels = plt.subplots(len(groups), 1, figsize=(10, 0.7 + 0.27 * sum(heights)), squeeze=False, sharex=True, height_ratios=heights, layout="constrained")
    for axes, (label, rows) in zip(panels[:, 0], groups):
        draw_panel(axes, label, rows)
    panels[-1, 0].set_xscale("log")
    panels[-1, 0].set_xlim(LEAST, 1e6)
    panels[-1, 0].set_xlabel("relative error of displacements, largest over the saved times")
    output.parent.mkdir(parents=True, exist_ok=True)
    save(figure, output, measured_by(path), dpi=110)
    plt.close(figure)
    return None


if __name__ == "__main__":
    draw_from_command_line(__doc__, draw, "error_budget")
