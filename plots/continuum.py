#!/usr/bin/python3
"""How lattices converge to the continuum under refinement: error against the edge of an element.

Reads results/tables/continuum.csv, as `dssbench experiment continuum` writes it, and nothing else.
Full: against theory. Open and dotted: against the lattice's own limit by Richardson's extrapolation of the three finest, whose order is in the title. Where the two part, theory
and lattice differ. Grey: a slope of 2. Dashed: the bar, drawn from the stated refinement on.
Example: plots/continuum.py results/tables/continuum.csv --output results/figures/continuum.png
"""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy  # noqa: E402
import pandas  # noqa: E402
from picture_command import draw_from_command_line  # noqa: E402
from report.pictures import measured_by, save  # noqa: E402

COLOURS = ["#0072B2", "#E69F00", "#009E73", "#CC79A7"]  # Okabe and Ito's
COLUMNS = 3
TICKS = [0.02, 0.05, 0.1, 0.2]


def draw_check(axes, check, rows):
    """One quantity: a line a mode, against theory and against its own limit."""
    orders = []
    for place, (mode, line) in enumerate(rows.groupby("mode")):
        line = line.sort_values("spacing_m")
        colour = COLOURS[place % len(COLOURS)]
        axes.plot(line["spacing_m"], line["error"].abs(), color=colour, marker="o", markersize=6 - 1.5 * place, linewidth=2.2 - 0.6 * place, label=f"mode {mode:g}")
        limit = line["richardson_limit"].iloc[0]
        coarser = line.iloc[1:]
        if numpy.isfinite(limit):
            axes.plot(coarser["spacing_m"], (coarser["figure"] / limit - 1).abs(), color=colour, marker="o", markersize=5, markerfacecolor="none", linewidth=1, linestyle=":")
            orders.append(f"{line['richardson_order'].iloc[0]:.2f}")
    spacing = numpy.array([rows["spacing_m"].min(), rows["spacing_m"].max()])
    coarsest = rows[rows["spacing_m"] == spacing[1]]["error"].abs().max()
    axes.plot(spacing, 1.8 * coarsest * (spacing / spacing[1]) ** 2, color="#999999", linewidth=1)
    stated = rows[rows["value"] >= rows["bar_at"]]
    if not stated.empty:
        axes.plot([stated["spacing_m"].min(), stated["spacing_m"].max()], [stated["bar"].iloc[0]] * 2, color="black", linewidth=0.9, linestyle="--")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xticks(TICKS, [f"{tick:g}" for tick in TICKS])
    axes.minorticks_off()
    axes.set_xlim(0.012, 0.32)
    axes.set_title(f"{check.replace('_', ' ')}\norder {', '.join(orders) or '-'}" + ("  FAILED" if (rows["status"] == "failed").any() else ""), fontsize=9, loc="left")
    axes.grid(alpha=0.3)
    axes.spines[["top", "right"]].set_visible(False)
    if rows["mode"].nunique() > 1:
        axes.legend(frameon=False, fontsize=7.5, loc="lower right")


def draw(path, output):
    """Writes the figure; returns a line that says why there is none, or None."""
    table = pandas.read_csv(path)
    if "richardson_order" not in table.columns or table.empty:
        return f"{path}: no continuum checks"
    checks = list(table.groupby("check", sort=False))
    count = -(-len(checks) // COLUMNS)
    figure, axes = plt.subplots(count, COLUMNS, figsize=(10, 2.7 * count), squeeze=False, layout="constrained")
    for place, axis in enumerate(axes.flat):
        if place >= len(checks):
            axis.axis("off")
            continue
        draw_check(axis, *checks[place])
        if place % COLUMNS == 0:
            axis.set_ylabel("relative error")
        if place >= len(checks) - COLUMNS:
            axis.set_xlabel("edge of an element, m")
    output.parent.mkdir(parents=True, exist_ok=True)
    save(figure, output, measured_by(path), dpi=150)
    plt.close(figure)
    return None


if __name__ == "__main__":
    draw_from_command_line(__doc__, draw, "continuum")
