#!/usr/bin/python3
"""Simulated clusters: exchanges and efficiency over the size of the problem, and weak scaling, for each network and node.

Reads results/tables/NAME_simulated.csv, as `dssbench experiment` writes it, and nothing else; never runs a solver or a simulator.
Example: plots/cluster_lines.py results/tables/cluster_simulated.csv --output results/figures/cluster_simulated.png
"""
import argparse
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import pandas  # noqa: E402

from report.pictures import measured_by, save  # noqa: E402
from scaling_lines import OTHER_STYLE, STYLES  # noqa: E402

NODES = {"paper": "the paper's node", "own": "one core of this machine"}


def networks_of(rows):
    """Names with their latency and bandwidth, slowest first."""
    for name, group in sorted(rows.groupby("network"), key=lambda pair: -pair[1]["latency_us"].max()):
        figures = group[["latency_us", "bandwidth_mb_per_s"]].max()
        yield name, f"{name}\n{figures.iloc[0]:.3g} us, {figures.iloc[1]:.4g} MB/s", group


def draw_lines(axes, rows, over, column):
    for halo, line in rows[rows[column].notna()].groupby("halo", sort=False):
        colour, marker = STYLES.get(halo, OTHER_STYLE)
        line = line.sort_values(over)
        axes.plot(line[over], line[column], color=colour, marker=marker, markersize=4, linewidth=1, label=halo)


def draw_sizes(axes_column, rows, node):
    """Seconds in exchanges (a level line: latency rules; one that rises with the side n: bandwidth), and efficiency below."""
    draw_lines(axes_column[0], rows[rows["halo"] != "auto"], "n", f"simulated_{node}_node_communication_s")
    draw_lines(axes_column[1], rows, "n", f"simulated_{node}_node_efficiency")
    for axes in axes_column:
        axes.set_xscale("log")
        axes.grid(alpha=0.3)
    axes_column[0].set_yscale("log")
    axes_column[1].axhline(0.95, color="#999999", linewidth=0.8, linestyle="--")
    axes_column[1].set_ylim(0, 1.25)
    axes_column[1].set_xlabel("elements a side, 6 nodes")


def draw(table, output):
    """Draws a table; says why not if it has nothing to draw."""
    rows = pandas.read_csv(table)
    if "network" not in rows or rows["network"].isna().all():
        return f"{table}: nothing simulated"
    rows = rows[rows["status"] == "ok"].copy()
    rows["n"] = pandas.to_numeric(rows["set"].astype(str).str.extract(r"n=(\d+)")[0])
    sizes = rows[(rows["ranks"] > 1) & (rows["label"] == "sizes")]
    if sizes.empty:
        return f"{table}: no block \"sizes\""
    panels = [(label, node, group) for node in NODES for _, label, group in networks_of(sizes)
              if group[f"simulated_{node}_node_wall_s"].notna().any()]
    weak = rows[rows["label"] == "weak scaling"]
    figure, axes = plt.subplots(2, len(panels) + (not weak.empty), figsize=(3.1 * (len(panels) + 1), 6), squeeze=False)
    for place, (label, node, group) in enumerate(panels):
        axes[0][place].set_title(f"{NODES[node]}\n{label}", fontsize=8)
        draw_sizes(axes[:, place], group, node)
    axes[0][0].set_ylabel("simulated seconds in exchanges\n(10,000 steps, mean over nodes)")
    axes[1][0].set_ylabel("simulated efficiency")
    axes[1][0].legend(fontsize=7)
    if not weak.empty:
        axes[0][-1].set_title("weak scaling, our node,\n390,625 elements a node", fontsize=8)
        for name, _, group in networks_of(weak):
            axes[0][-1].plot(group["ranks"], group["simulated_own_node_efficiency"], marker="o", markersize=4, label=name)
        axes[0][-1].set_xscale("log", base=2)
        axes[0][-1].set_ylim(0, 1.1)
        axes[0][-1].set_xlabel("nodes")
        axes[0][-1].grid(alpha=0.3)
        axes[0][-1].legend(fontsize=7)
        axes[1][-1].axis("off")
    figure.tight_layout()
    output.parent.mkdir(parents=True, exist_ok=True)
    save(figure, output, measured_by(table), dpi=130)
    plt.close(figure)
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("table", type=pathlib.Path)
    parser.add_argument("--output", type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    message = draw(arguments.table, arguments.output)
    if message:
        sys.exit(message)


if __name__ == "__main__":
    main()
