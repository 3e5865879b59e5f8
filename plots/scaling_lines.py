#!/usr/bin/python3
"""Speed-up over ranks for each halo strategy, with the ideal line; the share of time in exchanges below; weak scaling.

Reads results/tables/NAME.csv, as `dssbench experiment` writes it, and nothing else; never runs a solver.
Points with more workers than cores are hollow: ratios of times, no speed-ups, and labelled so.
Example: plots/scaling_lines.py results/tables/table1.csv --output results/figures/table1_scaling.png
"""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import pandas  # noqa: E402
from picture_command import draw_from_command_line  # noqa: E402
from report.pictures import measured_by, save  # noqa: E402

# Okabe and Ito's colours: told apart with any colour vision; markers differ too.
STYLES = {
    "sendrecv": ("#D55E00", "s"),
    "overlap": ("#E69F00", "^"),
    "deep": ("#0072B2", "o"),
    "deep-overlap": ("#56B4E9", "D"),
    "shared": ("#009E73", "v"),
    "auto": ("#CC79A7", "P"),
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


def lines_of(rows):
    """(label, colour, marker, shift, points) of each halo strategy; points of several at one rank stand side by side."""
    groups = list(rows.groupby(["halo", "decomposition"], sort=False))
    for place, ((halo, decomposition), line) in enumerate(groups):
        label = halo if decomposition == "strips" else f"{halo}, {decomposition}"
        yield label, *STYLES.get(halo, OTHER_STYLE), 0.07 * (place - (len(groups) - 1) / 2), line


def draw_points(axes, line, heights, colour, marker, shift):
    """Filled where they count, hollow where there are more workers than cores."""
    for is_hollow, group in line.groupby("is_hollow"):
        axes.plot(group["ranks"] + shift, heights[group.index], marker=marker, linestyle="none", color=colour, markersize=6,
                  markerfacecolor="white" if is_hollow else colour, zorder=3)


def draw_lines(axes, rows, measured):
    """A line a halo strategy from the point of 1 rank, with the intervals of what is a speed-up or an efficiency."""
    for label, colour, marker, shift, line in lines_of(rows):
        axes.plot([1, *(line["ranks"] + shift)], [1, *line["point"]], color=colour, linewidth=1, alpha=0.6)
        draw_points(axes, line, line["point"], colour, marker, shift)
        axes.plot([], [], color=colour, marker=marker, label=label)
        known = line[~line["is_hollow"] & line[f"{measured}_low"].notna()]
        if not known.empty:
            reach = [(known["point"] - known[f"{measured}_low"]).clip(lower=0), (known[f"{measured}_high"] - known["point"]).clip(lower=0)]
            axes.errorbar(known["ranks"] + shift, known["point"], yerr=reach, fmt="none", ecolor=colour, capsize=3)


def draw_shares(axes, rows):
    """Share of the wall time that ranks spend in exchanges."""
    for _, colour, marker, shift, line in lines_of(rows):
        axes.plot(line["ranks"] + shift, 100 * line["communication_share"], color=colour, linewidth=1, alpha=0.6)
        draw_points(axes, line, 100 * line["communication_share"], colour, marker, shift)
    axes.set_ylim(0, 105)
    axes.set_ylabel("in exchanges [%]")
    axes.set_xlabel("ranks")


def draw_panel(above, below, title, rows, is_strong):
    """One problem: lines above, shares of exchanges below."""
    draw_lines(above, rows, "speedup_vs_1_rank" if is_strong else "weak_efficiency")
    most = int(rows["ranks"].max())
    above.plot([1, most], [1, most if is_strong else 1], color="black", linewidth=0.8, linestyle=":", label="ideal")
    counted = rows[~rows["is_hollow"]]
    ideal = 1 if counted.empty or not is_strong else counted["ranks"].max()
    above.set_ylim(0, 1.15 * max(ideal, rows["point"].max(), rows["speedup_vs_1_rank_high" if is_strong else "weak_efficiency_high"].max()))
    above.set_title(title, fontsize=9, loc="left")
    above.set_ylabel("speed-up against 1 rank" if is_strong else "element-steps/s of a rank, against 1 rank")
    draw_shares(below, rows)
    for axes in (above, below):
        axes.spines[["top", "right"]].set_visible(False)
        axes.set_xlim(0.7, most + 0.4)
        axes.set_xticks([1, *sorted(rows["ranks"].astype(int).unique())])
    if rows["is_hollow"].any():
        border = (rows["cores"] / rows["threads"]).iloc[0] + 0.5
        for axes in (above, below):
            axes.axvspan(border, most + 0.4, color="#000000", alpha=0.05, linewidth=0)
        above.annotate("oversubscribed: no speed-up", (border, 1), xycoords=("data", "axes fraction"), xytext=(3, -3),
                       textcoords="offset points", fontsize=8, va="top")


def strong_panels(table):
    """(title, rows) of every problem with cells on 1 and on several ranks."""
    for name, group in table.groupby(PROBLEM + ["set"], sort=False, dropna=False):
        base = group[group["ranks"] == 1]
        if base.empty or (group["ranks"] > 1).sum() == 0:
            continue
        rows = with_points(group[group["ranks"] > 1], base.iloc[0], "speedup_vs_1_rank", lambda cells: 1)
        if not rows.empty:
            yield f"{name[1]}, {name[0]} {name[-1]}, {int(name[2])} thread{'s' if name[2] > 1 else ''} a rank", rows


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
    table = table[(table["source"] == "measured") & table["element_steps_per_s"].notna() & ~table["label"].fillna("").str.contains("A/A", regex=False)]
    table = table[table["status"].isin(["ok", "oversubscribed"])]
    strong = list(strong_panels(table))
    weak = list(weak_panels(table)) if table["weak_base_set"].notna().any() else []
    if not strong and not weak:
        return f"{path}: no cell on several ranks has its like on one"
    count = len(strong) + len(weak)
    figure, panels = plt.subplots(2, count, figsize=(2 + 4 * count, 6), squeeze=False, height_ratios=[3, 1.3], layout="constrained")
    labels = {}
    for place, (title, rows) in enumerate(strong + weak):
        draw_panel(panels[0, place], panels[1, place], title, rows, place < len(strong))
        labels.update({label: line for line, label in zip(*panels[0, place].get_legend_handles_labels())})
    panels[0, -1].legend(labels.values(), labels.keys(), loc="center left", bbox_to_anchor=(1.02, 0.5), frameon=False, fontsize=9, title="halo")
    figure.suptitle("Medians of paired ratios, 95 % intervals; hollow: more workers than cores, ratio of median rates", fontsize=9, x=0.01, ha="left")
    output.parent.mkdir(parents=True, exist_ok=True)
    save(figure, output, measured_by(path), dpi=150)
    plt.close(figure)
    return None


if __name__ == "__main__":
    draw_from_command_line(__doc__, draw)
