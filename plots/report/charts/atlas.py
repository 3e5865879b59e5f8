"""The failure atlas: methods by cases, with theory's reason for each cell."""
from failure_atlas import METRICS

from ..words import escaped
from .chart import Chart, Filter, points

# Okabe and Ito's colours, and a mark for each verdict.
VERDICTS = {"ok": ("#009E73", "square"), "inaccurate": ("#E69F00", "triangle-up"), "drifts": ("#56B4E9", "diamond"), "unstable": ("#D55E00", "x"), "refused": ("#999999", "circle-open")}
COLUMNS = {"case": "case", "method": "method", "set": "set", "precision": "precision", "rotation": "rotation", "model": "model", "verdict": "verdict", "expected": "expected", "why": "why", "metric_name": "measure",
           "figure": "figure", "predicted": "predicted", "deviation": "figure / predicted - 1", "dt_s": "step [s]", "status": "status", "reason": "reason"}
FILTERS = [Filter("verdict", "Verdict"), Filter("expected", "Expected"), Filter("precision", "Precision"), Filter("method", "Method"), Filter("status", "As theory says")]


def row_of(cell):
    """The line of the atlas that a cell is on: its case, and its precision and rotation where these are the point."""
    special = [cell["precision"]] * (cell["precision"] != "f64") + [str(cell["rotation"]).replace("tait_bryan", "angles")] * (cell["rotation"] != "quaternion")
    return ", ".join([str(cell["case"]).replace("_", " "), *special])


def atlas(results):
    frame = results.table("failures", "case", "set", "method", "precision", "rotation", "metric", "figure", "verdict", "expected", "why", "status")
    frame["metric_name"] = frame["metric"].map(lambda metric: METRICS.get(metric, metric))
    frame["row"] = [row_of(cell) for _, cell in frame.iterrows()]
    rows, methods = list(dict.fromkeys(frame["row"])), list(dict.fromkeys(frame["method"]))
    # Variations of one cell stand side by side.
    place, count = frame.groupby(["row", "method"]).cumcount(), frame.groupby(["row", "method"])["line"].transform("count")
    frame["x"] = frame["method"].map(methods.index) + (place - (count - 1) / 2) * 0.8 / count.clip(lower=2)
    frame["y"] = frame["row"].map(rows.index)
    traces = []
    for (verdict, _, _, _, status), cells in frame.groupby(["verdict", "expected", "precision", "method", "status"], sort=False):
        colour, symbol = VERDICTS.get(verdict, ("ink", "star"))
        sizes = [11 if many < 4 else 8 for many in count[cells.index]]
        traces.append(points(cells, "failures", "x", "y", ["verdict", "expected", "precision", "method", "status"], COLUMNS, mode="markers", name=verdict, legendgroup=verdict,
                             marker={"symbol": symbol, "size": sizes, "color": colour, "opacity": 1, "line": {"width": 3 if status == "failed" else 1.5, "color": "ink" if status == "failed" else colour}}))
    wrong, refused = (frame["status"] == "failed").sum(), (~frame["verdict"].isin(["ok"])).sum()
    text = (f"Which method works on which case, and what becomes of it where it does not: {len(frame)} cells, {refused} of them not ok; "
            f"{wrong if wrong else 'none'} {'is' if wrong < 2 else 'are'} other than theory says{' (thick edge)' if wrong else ''}. Each cell says its verdict, the expected one and the reason.")
    layout = {"xaxis": {"tickvals": list(range(len(methods))), "ticktext": [method.replace("_", "<br>", 1) for method in methods], "side": "top", "range": [-0.6, len(methods) - 0.4], "tickangle": 0},
              "yaxis": {"tickvals": list(range(len(rows))), "ticktext": [escaped(row) for row in rows], "range": [len(rows) - 0.4, -0.6], "automargin": True}}
    return Chart(text, "failures", traces, layout, frame, COLUMNS, FILTERS, height=160 + 22 * len(rows))
