#!/usr/bin/python3
"""Model ladder: error against the spatial oracle over the time of a run, a panel a scene, a point a model.

Reads results/tables/model_ladder.csv, as `dssbench experiment model_ladder` writes it, and nothing else; never runs a solver.
Filled: within the scene's tolerance (dashed line). Hollow: not. At the left edge: models without the degrees of freedom, by the oracle, which has no time here. Ring: auto.
Example: plots/model_ladder.py results/tables/model_ladder.csv --output results/figures/model_ladder.png
"""

import math

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import pandas  # noqa: E402
from matplotlib.lines import Line2D  # noqa: E402
from matplotlib.ticker import NullFormatter  # noqa: E402
from picture_command import draw_from_command_line  # noqa: E402
from report.pictures import measured_by, save  # noqa: E402

# Okabe and Ito's colours, and grey, from the least work to the most.
COLOURS = {"axial": "#56B4E9", "bending": "#E69F00", "membrane": "#999999", "planar": "#009E73", "linear": "#CC79A7", "small": "#D55E00", "spatial": "#0072B2"}
LEAST, MOST = 1e-17, 1e3  # errors beyond are drawn at the edge
COLUMNS = 5


def shown(error):
    """An error on the axis, whatever it is."""
    return MOST if pandas.isna(error) or math.isinf(error) else min(max(error, LEAST), MOST)


def draw_point(axes, row):
    """One model."""
    colour = COLOURS[row["model"]]
    style = {"marker": "o", "markersize": 6, "color": colour, "markerfacecolor": colour if row["verdict"] == "sufficient" else "white", "linestyle": "none", "zorder": 3}
    if pandas.isna(row["wall_s"]):
        axes.plot(0.03, shown(row["error"]), transform=axes.get_yaxis_transform(), **style)
    else:
        axes.plot(row["wall_s"], shown(row["error"]), **style)


def draw_panel(axes, rows):
    """One scene in one precision."""
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylim(LEAST / 3, 3 * MOST)
    for _, row in rows[rows["model"] != "auto"].iterrows():
        draw_point(axes, row)
    chosen = rows[rows["model"] == "auto"].iloc[0]
    axes.plot(chosen["wall_s"], shown(chosen["error"]), marker="o", markersize=11, markerfacecolor="none", color="#000000", linestyle="none", zorder=4)
    axes.axhline(chosen["tolerance"], color="#444444", linestyle="--", linewidth=0.8)
    start, end = axes.get_xlim()
    axes.set_xlim(start / 3, end)
    promoted = f", {int(chosen['promotions'])} promoted" if chosen["promotions"] > 0 else ""
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_title(f"{chosen['scene']} {chosen['precision']}: {chosen['ends_with']}{promoted}", fontsize=8.5, loc="left")
    axes.tick_params(labelsize=7)
    axes.grid(alpha=0.25)
    axes.spines[["top", "right"]].set_visible(False)


def draw(path, output):
    """Writes the figure; returns a line that says why there is none, or None."""
    table = pandas.read_csv(path)
    if "ends_with" not in table.columns or "provable" not in table.columns:
        return f"{path}: is no model ladder; make one with `dssbench experiment model_ladder`"
    table["set"] = table["set"].fillna("")
    groups = [rows for _, rows in table.groupby(["scene", "set", "precision", "steps"], sort=False)]
    lines = math.ceil(len(groups) / COLUMNS)
    figure, panels = plt.subplots(lines, COLUMNS, figsize=(3.2 * COLUMNS, 0.8 + 2.2 * lines), squeeze=False, sharey=True, layout="constrained")
    for axes, rows in zip(panels.flat, groups):
        draw_panel(axes, rows)
    for axes in list(panels.flat)[len(groups):]:
        axes.set_axis_off()
    entries = [Line2D([], [], color=colour, marker="o", linestyle="none", label=model) for model, colour in COLOURS.items()]
    entries.append(Line2D([], [], color="#000000", marker="o", markersize=11, markerfacecolor="none", linestyle="none", label="auto"))
    figure.suptitle(" ", fontsize=14)  # room for the legend
    figure.legend(handles=entries, loc="upper right", ncol=len(entries), fontsize=9, frameon=False).set_in_layout(False)
    figure.supxlabel("time of a run [s]", fontsize=9)
    figure.supylabel("relative error against the spatial oracle", fontsize=9)
    output.parent.mkdir(parents=True, exist_ok=True)
    save(figure, output, measured_by(path), dpi=110)
    plt.close(figure)
    return None


if __name__ == "__main__":
    draw_from_command_line(__doc__, draw, "model_ladder")
