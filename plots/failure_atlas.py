#!/usr/bin/python3
"""The failure atlas: which method works on which scene, and what becomes of it where it does not.

Reads results/tables/failures.csv, as `dssbench experiment failures` writes it, and nothing else.
A row is a case (with its precision, rotation or model where that is the point), a column a method, the colour the verdict, the number the figure that says so:
of several variations the one farthest from right. A cell of several colours has several variations, in their order. A black frame: not what theory says.
Example: plots/failure_atlas.py results/tables/failures.csv --output results/figures/failures.png
"""
import math
import textwrap

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import pandas  # noqa: E402
from matplotlib.patches import Patch, Rectangle  # noqa: E402
from picture_command import draw_from_command_line  # noqa: E402
from report.pictures import measured_by, save  # noqa: E402

# After Okabe and Ito, lightened so that black text stands on them: told apart with any colour vision.
COLOURS = {"ok": "#7FCDB5", "inaccurate": "#F2C75C", "drifts": "#9AD1F0", "unstable": "#E8915A", "refused": "#C9C9C9"}
METRICS = {
    "error": "relative error",
    "travel_error": "error of the way",
    "observed_order": "observed order",
    "energy_change": "change of energy",
    "energy_trend": "trend of energy",
    "amplitude": "growth",
    "tip_gap": "gap at closing",
    "value": "deflection",
}


def row_label(cells):
    """What a row is: its case, what sets it apart from others of the case, what its numbers are."""
    first = cells.iloc[0]
    special = [first["precision"]] * (first["precision"] != "f64") + [first["rotation"]] * (first["rotation"] != "quaternion")
    sets = [text for text in cells["set"].unique() if text]
    keys = sets[0].split("=")[0] if len(sets) > 1 and " " not in sets[0] else ""
    many = f" ({len(sets)} values of {keys})" if keys else f" ({len(sets)} variations)" if len(sets) > 1 else ""
    return f"{first['case'].replace('_', ' ')}{many}{''.join(', ' + text for text in special)}", METRICS.get(first["metric"], first["metric"])


def shown_figure(cells):
    """The figure of the cell that is farthest from right, in three letters or a little more."""
    if (cells["verdict"] == "refused").all():
        return "refused"
    figures = cells["figure"].dropna()
    if len(figures) < (cells["verdict"] != "refused").sum():
        return "inf"
    worst = min(figures) if cells["metric"].iloc[0] == "observed_order" else max(figures, key=abs)
    if worst == 0:
        return "0"
    decade = math.floor(math.log10(abs(worst)))
    text = f"{worst:.2g}" if -3 <= decade < 2 else f"{worst:.0f}" if decade == 2 else f"{worst:.0e}"
    return text.replace("e-0", "e-").replace("e+0", "e").replace("e+", "e")


def draw_cell(axes, column, row, cells):
    """One method in one row: a strip for each variation."""
    width = 1 / len(cells)
    for place, verdict in enumerate(cells["verdict"]):
        axes.add_patch(Rectangle((column + place * width, row), width, 1, facecolor=COLOURS.get(verdict, "white"), edgecolor="none"))
    is_wrong = (cells["status"] == "failed").any()
    axes.add_patch(Rectangle((column, row), 1, 1, fill=False, edgecolor="black" if is_wrong else "white", linewidth=2.2 if is_wrong else 1.2, zorder=3 if is_wrong else 2))
    axes.text(column + 0.5, row + 0.5, shown_figure(cells), ha="center", va="center", fontsize=7.5, zorder=4)


def draw(path, output):
    """Writes the figure; returns a line that says why there is none, or None."""
    table = pandas.read_csv(path, keep_default_na=False)
    if "verdict" not in table.columns or "expected" not in table.columns or table.empty:
        return f"{path}: no failure atlas"
    table["figure"] = pandas.to_numeric(table["figure"], errors="coerce")
    methods = list(dict.fromkeys(table["method"]))
    rows = list(table.groupby(["case", "precision", "rotation"], sort=False))
    wrong = [f"{row['case']} {row['set']} {row['method']} {row['precision']}: {row['reason']}" for _, row in table[table["status"] == "failed"].iterrows()]
    footnotes = [line for text in wrong[:12] for line in textwrap.wrap(text, 110)]
    width, height = 4.6 + 1.05 * len(methods), 0.9 + 0.25 * len(rows) + 0.16 * len(footnotes)
    figure, axes = plt.subplots(figsize=(width, height), layout="constrained")
    for place, (_, cells) in enumerate(rows):
        label, metric = row_label(cells)
        axes.text(-0.06, place + 0.5, label, ha="right", va="center", fontsize=8)
        axes.text(len(methods) + 0.06, place + 0.5, metric, ha="left", va="center", fontsize=7.5, color="#555555")
        for column, method in enumerate(methods):
            own = cells[cells["method"] == method]
            if not own.empty:
                draw_cell(axes, column, place, own)
    for column, method in enumerate(methods):
        axes.text(column + 0.5, -0.15, method.replace("_", "\n", 1), ha="center", va="bottom", fontsize=8)
    axes.set_xlim(-3.1, len(methods) + 1.25)
    axes.set_ylim(len(rows), -1.2)
    axes.axis("off")
    axes.legend(handles=[Patch(facecolor=colour, label=verdict) for verdict, colour in COLOURS.items()] + [Patch(fill=False, edgecolor="black", linewidth=2, label="not as theory says")],
                loc="upper center", bbox_to_anchor=(0.45, 0), ncols=6, frameon=False, fontsize=8, handlelength=1.2, columnspacing=1)
    if footnotes:
        figure.supxlabel("\n".join(footnotes), fontsize=7, x=0.01, ha="left")
    output.parent.mkdir(parents=True, exist_ok=True)
    save(figure, output, measured_by(path), dpi=150)
    plt.close(figure)
    return None


if __name__ == "__main__":
    draw_from_command_line(__doc__, draw, "failures")
