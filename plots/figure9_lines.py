#!/usr/bin/python3
"""The paper's figure 9: time of 10,000 steps over the side n of the plate, ours and the paper's.

Reads results/tables/NAME.csv, as `dssbench experiment` writes it, and nothing else; never runs a solver.
Filled marks and full lines are measured here (scaled to 10,000 steps where fewer ran), hollow marks and dashed lines are published. What
is not there (a GPU) is named as unavailable, and has no mark.
Example: plots/figure9_lines.py results/tables/table3.csv --output results/figures/table3_figure9.png
"""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import pandas  # noqa: E402
from picture_command import draw_from_command_line  # noqa: E402
from report.pictures import measured_by, save  # noqa: E402

STEPS = 10000
# Okabe and Ito's colours: told apart with any colour vision; markers differ too.
COLOURS = ["#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#000000", "#999999"]
MEASURED_MARKERS = "osD^vP*X"
PAPER_MARKERS = "osD^"


def with_side(rows):
    """Rows of plates, with their side n."""
    rows = rows.copy()
    rows["n"] = pandas.to_numeric(rows["set"].astype(str).str.extract(r"\bn=(\d+)")[0])
    return rows[rows["n"].notna()].sort_values("n", kind="stable")


def name_of(label, precision, has_several):
    return f"{label}, {precision}" if has_several else label


def draw_measured(axes, rows):
    """A line a configuration; its names are listed beside the axes."""
    has_several = rows["precision"].nunique() > 1
    timed = rows[rows["measured_wall_s"].notna() & (rows["status"] == "ok")]
    for place, ((label, precision), line) in enumerate(timed.groupby(["label", "precision"], sort=False)):
        axes.plot(line["n"], line["measured_wall_s"] / line["steps"] * STEPS, color=COLOURS[place % len(COLOURS)],
                  marker=MEASURED_MARKERS[place % len(MEASURED_MARKERS)], markersize=5, linewidth=1,
                  linestyle="-" if place < len(COLOURS) else "-.", label=name_of(label, precision, has_several))


def draw_paper(axes, rows):
    for place, (label, line) in enumerate(rows.groupby("label", sort=False)):
        axes.plot(line["n"], line["paper_wall_s"], color="#666666", marker=PAPER_MARKERS[place % len(PAPER_MARKERS)], markersize=6,
                  markerfacecolor="white", linewidth=1, linestyle="--", label=f"{label} (paper)")


def unavailable_names(rows):
    """Configurations that could not run here, with the reason of the first."""
    rows = rows[rows["status"] == "unavailable"]
    names = list(dict.fromkeys(rows["label"]))
    return names, (str(rows["reason"].iloc[0]) if names else "")


def draw(path, output):
    """Writes the figure; returns a line that says why there is none, or None."""
    table = pandas.read_csv(path)
    if not {"measured_wall_s", "paper_wall_s", "set", "device"}.issubset(table.columns):
        return f"{path}: has no columns of devices; measure it anew with `dssbench experiment`"
    table = with_side(table[~table["label"].astype(str).str.contains("A/A", regex=False)])
    measured, paper = table[table["source"] == "measured"], table[table["source"] == "paper"]
    if paper.empty or measured["n"].nunique() < 2:
        return f"{path}: no published times of plates beside measured ones"
    figure, axes = plt.subplots(figsize=(10, 5.5), layout="constrained")
    draw_measured(axes, measured)
    draw_paper(axes, paper)
    names, reason = unavailable_names(measured)
    for name in names:
        axes.plot([], [], linestyle="none", marker="x", color="#999999", label=f"{name}: unavailable")
    axes.set_xscale("log")
    axes.set_yscale("log")
    sides = sorted(table["n"].astype(int).unique())
    axes.set_xticks(sides, [str(n) for n in sides])
    axes.minorticks_off()
    axes.set_xlabel("elements a side, n" + (f"\nunavailable: {reason[:110]}" if names else ""), fontsize=9)
    axes.set_ylabel(f"time of {STEPS:,} steps [s]")
    axes.set_title("Filled: measured here, scaled to 10,000 steps where fewer ran; hollow: published, on the paper's machines", fontsize=9, loc="left")
    axes.grid(alpha=0.3)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), frameon=False, fontsize=8)
    output.parent.mkdir(parents=True, exist_ok=True)
    save(figure, output, measured_by(path), dpi=150)
    plt.close(figure)
    return None


if __name__ == "__main__":
    draw_from_command_line(__doc__, draw)
