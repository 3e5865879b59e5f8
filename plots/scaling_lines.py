#!/usr/bin/python3
"""Speed-up over ranks for each halo strategy, with the ideal line; the share of time in exchanges below; weak scaling.

Reads results/tables/NAME.csv, as `dssbench experiment` writes it, and nothing else; never runs a solver.
Points with more workers than cores are hollow: ratios of times, no speed-ups, and labelled so.
Example: plots/scaling_lines.py results/tables/table1.csv --output results/figures/table1_scaling.png
"""
import argparse
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import pandas  # noqa: E402
from matplotlib.ticker import MaxNLocator  # noqa: E402

# Okabe and Ito's colours: told apart with any colour vision; markers differ too.
STYLES = {
    "sendrecv": ("#D55E00", "s"),
    "overlap": ("#E69F00", "^"),
    "deep": ("#0072B2", "o"),
    "deep-overlap": ("#56B4E9", "D"),
    "shared": ("#009E73", "v"),
    "auto": ("#CC79A7", "*"),
}
OTHER_STYLE = ("#999999", "x")
# Rows that differ in these are no points of one line.
PROBLEM = ["scene", "variant", "threads", "model", "precision", "integrator"]


def with_points(rows, base, measured, scale):
    """Rows with the height of their point: the measured column, else (oversubscribed) `scale` times the ratio of rates to the base's."""
    rows = rows.copy()
    ratio = scale(rows) * rows["element_steps_per_s"] / base["element_steps_per_s"]
    rows["is_hollow"] = rows["status"] == "oversubscribed"
    rows["point"] = rows[measured].where(~rows["is_hollow"], ratio)
    return rows[rows["point"].notna()].sort_values("ranks")


def draw_lines(axes, rows, measured, first):
    """A line a halo strategy from the point of 1 rank; filled points with intervals, hollow ones without."""
    for (halo, decomposition), line in rows.groupby(["halo", "decomposition"], sort=False):
        colour, marker = STYLES.get(halo, OTHER_STYLE)
        label = halo if decomposition == "strips" else f"{halo}, {decomposition}"
        start = [(1, first)] if first is not None else []
        points = start + list(zip(line["ranks"], line["point"]))
        axes.plot(*zip(*points), color=colour, linewidth=1, alpha=0.6)
        for is_hollow, group in line.groupby("is_hollow"):
            axes.plot(group["ranks"], group["point"], marker=marker, linestyle="none", color=colour, markersize=6,
                      markerfacecolor="white" if is_hollow else colour, zorder=3)
        axes.plot([], [], color=colour, marker=marker, label=label)
        known = line[~line["is_hollow"] & line[f"{measured}_low"].notna()]
        if not known.empty:
            reach = [(known["point"] - known[f"{measured}_low"]).clip(lower=0), (known[f"{measured}_high"] - known["point"]).clip(lower=0)]
            axes.errorbar(known["ranks"], known["point"], yerr=reach, fmt="none", ecolor=colour, capsize=3)


def draw_shares(axes, rows):
    """Share of the wall time that ranks spend in exchanges."""
    for (halo, _), line in rows.groupby(["halo", "decomposition"], sort=False):
        colour, marker = STYLES.get(halo, OTHER_STYLE)
        axes.plot(line["ranks"], 100 * line["communication_share"], color=colour, linewidth=1, alpha=0.6)
        for is_hollow, group in line.groupby("is_hollow"):
            axes.plot(group["ranks"], 100 * group["communication_share"], marker=marker, linestyle="none", color=colour,
                      markerfacecolor="white" if is_hollow else colour)
    axes.set_ylim(0, 100)
    axes.set_ylabel("in exchanges [%]")


def finish(axes, rows):
    """What all panels have in common; a label where cores end."""
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.set_xlabel("ranks")
    axes.spines[["top", "right"]].set_visible(False)
    if rows["is_hollow"].any():
        border = (rows["cores"] / rows["threads"]).iloc[0] + 0.5
        axes.axvspan(border, rows["ranks"].max() + 0.4, color="#000000", alpha=0.05, linewidth=0)
        axes.annotate("oversubscribed: no speed-up", (border, 1), xycoords=("data", "axes fraction"), xytext=(3, -3),
                      textcoords="offset points", fontsize=8, va="top")


def strong_panels(table):
    """(title, rows) of every problem with cells on 1 and on several ranks."""
    for name, group in table.groupby(PROBLEM + ["set"], sort=False, dropna=False):
        base = group[group["ranks"] == 1]
        if base.empty or (group["ranks"] > 1).sum() == 0:
            continue
        rows = with_points(group[group["ranks"] > 1], base.iloc[0], "speedup_vs_1_rank", lambda cells: 1)
        if not rows.empty:
            yield f"{name[1]}, {name[0]} {name[-1]}, {name[2]} thread{'s' if name[2] > 1 else ''} a rank", rows


def weak_panels(table):
    """The same of problems that grow with the ranks: efficiencies."""
    for name, group in table[table["weak_base_set"].notna()].groupby(PROBLEM + ["weak_base_set"], sort=False):
        base = table[(table[PROBLEM] == pandas.Series(name[:-1], index=PROBLEM)).all(axis=1) & (table["ranks"] == 1) & (table["set"] == name[-1])]
        if base.empty:
            continue
        rows = with_points(group[group["ranks"] > 1], base.iloc[0], "weak_efficiency", lambda cells: 1 / cells["ranks"])
        if not rows.empty:
            yield f"weak, {name[1]}, {name[0]} from {name[-1]}", rows


def draw(path, output):
    """Writes the figure; returns a line that says why there is none, or None."""
    table = pandas.read_csv(path)
    if "speedup_vs_1_rank" not in table.columns:
        return f"{path}: has no column speedup_vs_1_rank; measure it anew with `dssbench experiment`"
    table = table[(table["source"] == "measured") & table["element_steps_per_s"].notna() & ~table["label"].str.contains("A/A", regex=False)]
    table = table[table["status"].isin(["ok", "oversubscribed"])]
    strong = list(strong_panels(table))
    # A problem that only the weak scaling has on these ranks makes no line of its own.
    weak = list(weak_panels(table)) if table["weak_base_set"].notna().any() else []
    if not strong and not weak:
        return f"{path}: no cell on several ranks has its like on one"
    count = len(strong) + len(weak)
    figure, panels = plt.subplots(2, count, figsize=(1 + 4 * count, 6), squeeze=False, height_ratios=[3, 1.3], layout="constrained")
    for place, (title, rows) in enumerate(strong + weak):
        axes, is_strong = panels[0, place], place < len(strong)
        draw_lines(axes, rows, "speedup_vs_1_rank" if is_strong else "weak_efficiency", 1)
        most = int(rows["ranks"].max())
        axes.plot([1, most], [1, most if is_strong else 1], color="black", linewidth=0.8, linestyle=":", label="ideal")
        axes.set_ylim(0, max(rows["point"].max() * 1.15, float(rows["ranks"][~rows["is_hollow"]].max()) + 0.5 if is_strong and not rows["is_hollow"].all() else 1.2))
        axes.set_title(title, fontsize=9, loc="left")
        axes.set_ylabel("speed-up against 1 rank" if is_strong else "element-steps/s a rank, against 1 rank")
        axes.legend(fontsize=8, frameon=False, loc="lower left" if not is_strong else "upper left", bbox_to_anchor=(0, 0.94) if is_strong else None)
        draw_shares(panels[1, place], rows)
        for each in panels[:, place]:
            finish(each, rows)
    figure.suptitle("Medians of paired ratios with 95 % intervals; hollow: more workers than cores, ratio of median rates", fontsize=9, x=0.01, ha="left")
    output.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(output, dpi=150)
    plt.close(figure)
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("table", type=pathlib.Path, help="results/tables/NAME.csv")
    parser.add_argument("--output", type=pathlib.Path, required=True, help="PNG, SVG or PDF")
    arguments = parser.parse_args()
    if not arguments.table.exists():
        sys.exit(f"{arguments.table}: no such file; run `dssbench experiment` first")
    reason = draw(arguments.table, arguments.output)
    if reason:
        sys.exit(reason)
    print(arguments.output)


if __name__ == "__main__":
    main()
