#!/usr/bin/python3
"""Work against precision: error over median time, and over force evaluations x elements, a row a scene.

Reads results/tables/work_precision.csv, as `dssbench experiment work_precision` writes it, and nothing else; never runs a solver.
A colour a method, a line style a precision, a marker a variant; bars: 95 % intervals of the median; the thick grey line is the Pareto front. Hollow: below
10 x the solution's own error. Crosses at the edge: points that failed, by method, with the number of each kind in words.
Example: plots/work_precision.py results/tables/work_precision.csv --output results/figures/work_precision.png
"""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import pandas  # noqa: E402
from matplotlib.lines import Line2D  # noqa: E402
from matplotlib.ticker import NullFormatter  # noqa: E402
from picture_command import draw_from_command_line  # noqa: E402
from report.pictures import measured_by, save  # noqa: E402

# Okabe and Ito's colours: told apart with any colour vision. Two shades are of others: the adaptive dopri5's of its own, the smoothed Verlet's of Verlet's.
COLOURS = {"rk4": "#0072B2", "velocity_verlet": "#D55E00", "midpoint": "#009E73", "symplectic_euler": "#CC79A7", "dopri5": "#E69F00", "dopri5 adaptive": "#8B6100", "rkc2": "#56B4E9",
           "implicit_midpoint": "#000000", "smoothed_verlet": "#7A1F00"}
OTHER_COLOUR = "#999999"
LINES = {"f64": "-", "f32": ":", "f32c": "--"}
MARKERS = "osv^DPX"
PROBLEM = ["scene", "set", "end_time_s"]
WORKS = [("measured_wall_s", "median time of a run [s]"), ("evaluations", "force evaluations x elements")]
EDGE = {"refused": "above the stability limit", "unstable": "unstable", "inaccurate": "no correct digit", "wrong": "wrong", "failed": "failed"}


def draw_line(axes, rows, work, colour, line, marker):
    """Points of one method, precision and variant, joined in order of their steps."""
    rows = rows.sort_values(["dt_s", "rtol"])
    axes.plot(rows[work], rows["error_max"], color=colour, linestyle=line, linewidth=1.1, alpha=0.8, zorder=2)
    for below, points in rows.groupby("below_reference"):
        axes.plot(points[work], points["error_max"], linestyle="none", marker=marker, markersize=4, color=colour,
                  markerfacecolor="white" if below == "yes" else colour, zorder=3)
    known = rows[rows["measured_wall_low_s"].notna()]
    if work == "measured_wall_s" and not known.empty:
        reach = [(known[work] - known["measured_wall_low_s"]).clip(lower=0), (known["measured_wall_high_s"] - known[work]).clip(lower=0)]
        axes.errorbar(known[work], known["error_max"], xerr=reach, fmt="none", ecolor=colour, elinewidth=0.8, capsize=1.5, zorder=2)


def draw_front(axes, rows):
    """Steps through the points that nothing beats in both."""
    front = rows[rows["pareto"] == "yes"].sort_values("measured_wall_s")
    axes.step(front["measured_wall_s"], front["error_max"], where="post", color="#000000", alpha=0.18, linewidth=5, zorder=1)


def draw_failed(axes, failed, edge):
    """A cross at the upper edge for each method, and how many failed of what."""
    for place, (method, rows) in enumerate(failed.groupby("integrator", sort=False)):
        axes.plot(0.03 + 0.045 * place, 1.04, marker="x", markersize=6, markeredgewidth=1.6, color=COLOURS.get(method, OTHER_COLOUR),
                  transform=axes.transAxes, clip_on=False)
    words = ", ".join(f"{len(rows)} {EDGE.get(status, status)}" for status, rows in failed.groupby("status", sort=False))
    axes.annotate(words, (0.05 + 0.045 * failed["integrator"].nunique(), 1.04), xycoords="axes fraction", fontsize=7.5, va="center")


def draw_panel(axes, rows, work, markers):
    """One scene, against one measure of work."""
    good = rows[rows["status"] == "ok"]
    for (method, precision, variant), line in good.groupby(["integrator", "precision", "variant"], sort=False):
        draw_line(axes, line, work, COLOURS.get(method, OTHER_COLOUR), LINES.get(precision, "-."), markers[variant])
    if work == "measured_wall_s":
        draw_front(axes, good)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.grid(alpha=0.25)
    axes.spines[["top", "right"]].set_visible(False)
    failed = rows[rows["status"].isin(EDGE)]
    if not failed.empty:
        draw_failed(axes, failed, work)


def legend_of(table, markers):
    """What colours, lines and markers mean."""
    entries = [Line2D([], [], color=COLOURS.get(method, OTHER_COLOUR), linewidth=2, label=method) for method in table["integrator"].unique()]
    entries += [Line2D([], [], color="#444444", linestyle=LINES.get(precision, "-."), label=precision) for precision in table["precision"].unique()]
    entries += [Line2D([], [], color="#444444", linestyle="none", marker=marker, markersize=5, label=variant) for variant, marker in markers.items()]
    entries.append(Line2D([], [], color="#000000", alpha=0.18, linewidth=5, label="Pareto front"))
    entries.append(Line2D([], [], color="#444444", linestyle="none", marker="x", label="failed: at the edge"))
    if (table["below_reference"] == "yes").any():
        entries.append(Line2D([], [], color="#444444", linestyle="none", marker="o", markerfacecolor="white", label="below 10 x the\nsolution's own error"))
    return entries


def draw(path, output):
    """Writes the figure; returns a line that says why there is none, or None."""
    table = pandas.read_csv(path)
    if "error_max" not in table.columns or "pareto" not in table.columns:
        return f"{path}: has no errors against work; measure it with `dssbench experiment work_precision`"
    if "rtol" not in table.columns:
        return f"{path}: is of an earlier version, without tolerances; measure it with `dssbench experiment work_precision`"
    table.loc[table["rtol"].notna(), "integrator"] += " adaptive"
    if not (table["status"] == "ok").any():
        return f"{path}: no point was measured"
    markers = {variant: MARKERS[place % len(MARKERS)] for place, variant in enumerate(table.loc[table["status"] == "ok", "variant"].unique())}
    problems = list(table.groupby(PROBLEM, sort=False, dropna=False))
    figure, panels = plt.subplots(len(problems), 2, figsize=(11, 0.8 + 2.75 * len(problems)), squeeze=False, sharey="row", layout="constrained")
    for (name, rows), (left, right) in zip(problems, panels):
        for axes, (work, label) in zip((left, right), WORKS):
            draw_panel(axes, rows, work, markers)
            axes.set_xlabel(label, fontsize=8.5)
        set_text = "" if pandas.isna(name[1]) else name[1].replace("bodies/0/constants/", "") + ", "
        left.set_title(f"{name[0]}, {set_text}to {name[2]:g} s", fontsize=9.5, loc="left", pad=14)
        left.set_ylabel("largest error of displacements,\nrelative", fontsize=8.5)
    # Beside the panels and higher than one of them: the layout must not make room for it in a row.
    figure.get_layout_engine().set(rect=(0, 0, 0.83, 1))
    figure.legend(handles=legend_of(table, markers), loc="upper right", frameon=False, fontsize=8.5).set_in_layout(False)
    output.parent.mkdir(parents=True, exist_ok=True)
    save(figure, output, measured_by(path), dpi=110)
    plt.close(figure)
    return None


if __name__ == "__main__":
    draw_from_command_line(__doc__, draw, "work_precision")
