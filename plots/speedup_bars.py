#!/usr/bin/python3
"""Bar chart of the speed-ups of a results table, with 95 % intervals and the base's absolute time.

Reads results/tables/NAME.csv, as `dssbench experiment` writes it, and nothing else; never runs a solver.
Example: plots/speedup_bars.py results/tables/table1_host.csv --base scalar --output results/figures/table1_host.png
"""
import argparse
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import pandas  # noqa: E402
from report.pictures import measured_by, save  # noqa: E402

# Okabe and Ito's colours: told apart with any colour vision.
COLOURS = {
    "reference": "#999999",
    "scalar": "#E69F00",
    "scalar-native": "#56B4E9",
    "avx2": "#009E73",
    "avx512": "#0072B2",
}
OTHER_COLOUR = "#CC79A7"


def rows_with_speedup(table, base):
    """Measured rows that have a speed-up against `base`; a scaled one (from fewer steps) is marked by `is_scaled`."""
    rows = table[table["source"] == "measured"].copy()
    if "ranks" not in rows.columns:  # a table from before there were ranks
        rows["ranks"] = 1
    scaled = rows[f"speedup_vs_{base}"].isna()
    for end in ("", "_low", "_high"):
        exact, scaled_column = f"speedup_vs_{base}{end}", f"extrapolated_speedup_vs_{base}{end}"
        rows[f"speedup{end}"] = rows[exact].where(~scaled, rows[scaled_column])
    rows["is_scaled"] = scaled
    return rows[rows["speedup"].notna()]


def base_time(rows, base):
    """The absolute time of the base, in words."""
    own = rows[(rows["variant"] == base) & (rows["threads"] == 1) & (rows["ranks"] == 1) & ~rows["label"].str.contains("A/A")]
    if own.empty:
        return f"base {base}"
    row = own.iloc[0]
    return f"base: {base}, 1 thread, {row['measured_wall_s']:.3g} s for {int(row['steps'])} steps"


def draw_group(axes, rows, base, name):
    """One horizontal bar a cell."""
    rows = rows.iloc[::-1]
    places = range(len(rows))
    bars = axes.barh(places, rows["speedup"], color=[COLOURS.get(variant, OTHER_COLOUR) for variant in rows["variant"]])
    low = (rows["speedup"] - rows["speedup_low"]).clip(lower=0)
    high = (rows["speedup_high"] - rows["speedup"]).clip(lower=0)
    known = high.notna()  # fewer than six repetitions have no interval, and get no whisker
    if known.any():
        axes.errorbar(rows["speedup"][known], [place for place in places if known.iloc[place]], xerr=[low[known], high[known]],
                      fmt="none", ecolor="black", capsize=3)
    for bar, is_scaled in zip(bars, rows["is_scaled"]):
        if is_scaled:
            bar.set_hatch("//")
            bar.set_edgecolor("white")
    is_contaminated = 2 * rows["contaminated"] >= rows["repetitions"]
    for place, (value, reach, is_doubtful) in enumerate(zip(rows["speedup"], rows["speedup"] + high.fillna(0), is_contaminated)):
        axes.annotate(f"{value:.3g}" + ("  (contaminated)" if is_doubtful else ""), (reach, place), xytext=(5, 0), textcoords="offset points", va="center", fontsize=9,
                      bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5})
    axes.set_yticks(list(places), rows["label"])
    axes.set_xlim(0, float((rows["speedup"] + high.fillna(0)).max()) * 1.15)
    axes.axvline(1, color="black", linewidth=0.8, linestyle=":", zorder=0)
    axes.set_title(f"{name}   ({base_time(rows, base)})", fontsize=10, loc="left")
    axes.spines[["top", "right"]].set_visible(False)


def draw(path, base, output):
    """Writes the chart; returns a line that says why there is none, or None."""
    table = pandas.read_csv(path)
    if base is None:
        # Those against a variant have columns of scaled ones beside them; those against 1 rank have not.
        found = [c for c in table.columns if c.startswith("extrapolated_speedup_vs_") and not c.endswith(("_low", "_high"))]
        if not found:
            return f"{path}: has no speed-ups; give a table of results/tables"
        base = found[-1].removeprefix("extrapolated_speedup_vs_")
    if f"speedup_vs_{base}" not in table.columns:
        return f"{path}: has no column speedup_vs_{base}; give --base another variant"
    rows = rows_with_speedup(table, base)
    if rows.empty:
        return f"{path}: no cell has a speed-up against {base}"
    groups = list(rows.groupby(["scene", "set", "model", "precision", "integrator"], sort=False, dropna=False))
    heights = [len(group) for _, group in groups]
    figure, all_axes = plt.subplots(len(groups), 1, figsize=(9, 0.38 * sum(heights) + 0.9 * len(groups) + 0.7), squeeze=False,
                                    height_ratios=heights, layout="constrained")
    for axes, (name, group) in zip(all_axes[:, 0], groups):
        draw_group(axes, group, base, " ".join(str(part) for part in name if not pandas.isna(part)))
    resolution = rows["resolution"].dropna()
    note = f"Speed-up against {base} (1 thread): medians of paired ratios"
    note += ", 95 % intervals" if rows["speedup_low"].notna().any() else ", too few repetitions for intervals"
    if not resolution.empty:
        note += f"; resolution {100 * resolution.iloc[0]:.1f} %"
    if rows["is_scaled"].any():
        note += "\nhatched: scaled from fewer steps"
    all_axes[-1, 0].set_xlabel(note, fontsize=9)
    output.parent.mkdir(parents=True, exist_ok=True)
    save(figure, output, measured_by(path), dpi=150)
    plt.close(figure)
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("table", type=pathlib.Path, help="results/tables/NAME.csv")
    parser.add_argument("--base", help="variant that speed-ups refer to (default: the last of the table)")
    parser.add_argument("--output", type=pathlib.Path, required=True, help="PNG, SVG or PDF")
    arguments = parser.parse_args()
    if not arguments.table.exists():
        sys.exit(f"{arguments.table}: no such file; run `dssbench experiment` first")
    reason = draw(arguments.table, arguments.base, arguments.output)
    if reason:
        sys.exit(reason)
    print(arguments.output)


if __name__ == "__main__":
    main()
