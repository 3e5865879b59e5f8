#!/usr/bin/python3
"""Advice against truth: true errors over tolerances, and times over the cheapest configuration and of the paper's over that advised.

Reads results/tables/advise.csv, as `dssbench experiment advise` writes it, and nothing else.
Left: filled the true error, hollow the estimate; on or below the line a tolerance is met. Middle: above the dashed line something much cheaper was found.
Example: plots/advice.py results/tables/advise.csv --output results/figures/advise.png
"""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import pandas  # noqa: E402
from picture_command import draw_from_command_line  # noqa: E402
from report.pictures import measured_by, save  # noqa: E402

# Okabe and Ito's colours: told apart with any colour vision.
COLOURS = ["#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#000000", "#999999"]
BAR = 1.5  # times the cheapest


def draw(path, output):
    """Writes the figure; returns a line that says why there is none, or None."""
    table = pandas.read_csv(path)
    if "time_over_cheapest" not in table.columns or table["true_error"].notna().sum() == 0:
        return f"{path}: has no advice; make it with `dssbench experiment advise`"
    figure, (errors, ratios, gains) = plt.subplots(1, 3, figsize=(13, 4.2), layout="constrained")
    table["label"] = table["scene"] + " " + table["set"].fillna("")
    for place, (label, rows) in enumerate(table.groupby("label", sort=False)):
        look = {"color": COLOURS[place % len(COLOURS)], "marker": "o", "linewidth": 1}
        errors.plot(rows["tolerance"], rows["true_error"], label=label, **look)
        errors.plot(rows["tolerance"], rows["error_estimate"], **{**look, "linewidth": 0}, markerfacecolor="none", markersize=10)
        ratios.plot(rows["tolerance"], rows["time_over_cheapest"], **look)
        gains.plot(rows["tolerance"], rows["speedup_over_paper"], **look)
    ends = [table["tolerance"].min(), table["tolerance"].max()]
    errors.plot(ends, ends, color="black", linewidth=0.8, linestyle="--")
    ratios.axhline(BAR, color="black", linewidth=0.8, linestyle="--")
    gains.axhline(1, color="black", linewidth=0.8, linestyle="--")
    for axes, title in ((errors, "true error"), (ratios, "time over the cheapest found"), (gains, "times as fast as the paper's configuration")):
        axes.set_xscale("log")
        axes.set_title(title, fontsize=10, loc="left")
        axes.set_xlabel("tolerance")
        axes.grid(alpha=0.3)
        axes.spines[["top", "right"]].set_visible(False)
    errors.set_yscale("log")
    gains.set_yscale("log")
    ratios.set_ylim(bottom=0.9)
    gains.legend(*errors.get_legend_handles_labels(), loc="center left", bbox_to_anchor=(1.02, 0.5), frameon=False, fontsize=9)
    output.parent.mkdir(parents=True, exist_ok=True)
    save(figure, output, measured_by(path), dpi=130)
    plt.close(figure)
    return None


if __name__ == "__main__":
    draw_from_command_line(__doc__, draw, "advise")
