#!/usr/bin/python3
"""The modelled balance of a slow and a fast executor: what they reach together, over the ratio of their speeds. A model, not a measurement.

Reads results/tables/balance.csv, as `dssbench experiment balance` writes it, and nothing else.
Above: throughput over the sum of both speeds. Below: over the fast one alone; full lines: the best shares, dotted: two halves. Above 1 joining pays.
Example: plots/balance_lines.py results/tables/balance.csv --output results/figures/balance.png
"""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import pandas  # noqa: E402
from picture_command import draw_from_command_line  # noqa: E402
from report.pictures import measured_by, save  # noqa: E402

# Okabe and Ito's colours: told apart with any colour vision.
COLOURS = ["#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#000000", "#999999"]


def draw_panel(above, below, rows):
    """One link, overlapped or not: a line a plate."""
    for place, (n, line) in enumerate(rows.groupby("n")):
        colour, line = COLOURS[place % len(COLOURS)], line.sort_values("speed_ratio")
        above.plot(line["speed_ratio"], line["modelled_of_sum"], color=colour, marker="o", markersize=3, linewidth=1, label=f"n = {n}")
        below.plot(line["speed_ratio"], line["modelled_of_fast"], color=colour, marker="o", markersize=3, linewidth=1)
        below.plot(line["speed_ratio"], line["modelled_equal_split_of_fast"], color=colour, linewidth=1, linestyle=":")
    below.axhline(1, color="black", linewidth=0.8, linestyle="--")
    below.set_yscale("log")
    below.set_xlabel("speeds, fast over slow")
    above.set_ylim(0, 1.05)
    for axes in (above, below):
        axes.set_xscale("log")
        ratios = sorted(rows["speed_ratio"].unique())
        axes.set_xticks(ratios, [f"{ratio:g}" for ratio in ratios])
        axes.minorticks_off()
        axes.grid(alpha=0.3)
        axes.spines[["top", "right"]].set_visible(False)


def draw(path, output):
    """Writes the figure; returns a line that says why there is none, or None."""
    table = pandas.read_csv(path)
    if "modelled_of_sum" not in table.columns or table.empty:
        return f"{path}: no modelled balance"
    panels = list(table.groupby(["link", "overlapped"], sort=False))
    figure, axes = plt.subplots(2, len(panels), figsize=(1.5 + 3.4 * len(panels), 6.5), squeeze=False, sharey="row", layout="constrained")
    for place, ((link, overlapped), rows) in enumerate(panels):
        draw_panel(axes[0, place], axes[1, place], rows)
        how = "overlapped" if overlapped == "yes" else "not overlapped"
        axes[0, place].set_title(f"{link}, {how}\n{rows['latency_us'].iloc[0]:.3g} us, {rows['gb_per_s'].iloc[0]:.3g} GB/s", fontsize=9, loc="left")
    axes[0, 0].set_ylabel("over the sum of both")
    axes[1, 0].set_ylabel("over the fast one alone\n(dotted: two halves)")
    axes[0, -1].legend(loc="center left", bbox_to_anchor=(1.02, 0.5), frameon=False, fontsize=9)
    slow = table["slow_element_steps_per_s"].iloc[0]
    figure.suptitle(f"Modelled, not measured: the slow one makes {slow:.3g} element-steps/s", fontsize=9, x=0.01, ha="left")
    output.parent.mkdir(parents=True, exist_ok=True)
    save(figure, output, measured_by(path), dpi=150)
    plt.close(figure)
    return None


if __name__ == "__main__":
    draw_from_command_line(__doc__, draw, "balance")
