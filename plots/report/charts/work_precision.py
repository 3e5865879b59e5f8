"""Error against time and against evaluations, and what nothing beats in both."""
from work_precision import COLOURS, EDGE, OTHER_COLOUR

from ..results import NotMeasured
from ..words import problem
from .chart import DASHES, SYMBOLS, Chart, Filter, by_order, ink, logarithmic, points, whiskers

NEEDED = ["scene", "set", "variant", "precision", "integrator", "dt_s", "rtol", "error_max", "measured_wall_s", "evaluations", "pareto", "status", "reason", "below_reference"]
COLUMNS = {"problem": "scene", "integrator": "method", "precision": "precision", "variant": "variant", "dt_s": "step [s]", "rtol": "tolerance of steps", "error_max": "largest error",
           "measured_wall_s": "median time [s]", "evaluations": "evaluations x elements", "pareto": "on the front", "status": "status", "reason": "reason"}
FILTERS = [Filter("problem", "Scene", is_single=True), Filter("variant", "Variant"), Filter("precision", "Precision"), Filter("integrator", "Method")]


def rows_of(results):
    frame = results.table("work_precision", *NEEDED)
    frame.loc[frame["rtol"].notna(), "integrator"] += " adaptive"
    frame["problem"] = [problem(row["scene"], row["set"]) for _, row in frame.iterrows()]
    return frame


def colour_of(method):
    return ink(COLOURS.get(method, OTHER_COLOUR))


def line(rows, work, symbol):
    """Points of one method, precision and variant, in order of their steps; hollow below ten times the solution's own error."""
    rows = rows.sort_values(["dt_s", "rtol"])
    method = rows["integrator"].iloc[0]
    hollow = ["-open" if below == "yes" else "" for below in rows["below_reference"]]
    style = {"mode": "lines+markers", "name": method, "legendgroup": method, "line": {"color": colour_of(method), "width": 1.3, "dash": DASHES.get(rows["precision"].iloc[0], "dashdot")},
             "marker": {"size": 8, "symbol": [symbol + end for end in hollow]}}
    if work == "measured_wall_s" and {"measured_wall_low_s", "measured_wall_high_s"} <= set(rows):
        style["error_x"] = whiskers(rows, work, "measured_wall_low_s", "measured_wall_high_s")
    return points(rows, "work_precision", work, "error_max", ["problem", "variant", "precision", "integrator"], COLUMNS, **style)


def front(rows):
    rows = rows[rows["pareto"] == "yes"].sort_values("measured_wall_s")
    return points(rows, "work_precision", "measured_wall_s", "error_max", ["problem"], COLUMNS, mode="lines", name="Pareto front", legendgroup="front", hoverinfo="skip",
                  line={"color": "soft", "width": 7, "shape": "hv"}, opacity=0.45)


def crosses(failed):
    """What has no error stands at the upper edge, as crosses: on axes of their own."""
    for place, ((_, method, *_), rows) in enumerate(failed.groupby(["problem", "integrator", "precision", "variant"], sort=False)):
        rows = rows.assign(edge_x=0.02 + 0.03 * (place % 30), edge_y=0.985, status=rows["status"].map(lambda status: EDGE.get(status, status)))
        yield points(rows, "work_precision", "edge_x", "edge_y", ["problem", "variant", "precision", "integrator"], COLUMNS, mode="markers", name="failed: at the edge", legendgroup="failed",
                     xaxis="x2", yaxis="y2", marker={"symbol": "x-thin", "size": 9, "color": colour_of(method), "line": {"width": 2, "color": colour_of(method)}})


def against(work, title):
    def make(results):
        frame = rows_of(results)
        good, failed = frame[frame["status"] == "ok"], frame[frame["status"].isin(EDGE)]
        if good.empty:
            raise NotMeasured("no point was measured")
        symbols = by_order(good["variant"].unique(), SYMBOLS)
        traces = [front(rows) for _, rows in good.groupby("problem", sort=False) if work == "measured_wall_s" and (rows["pareto"] == "yes").any()]
        for (_, _, _, variant), rows in good.groupby(["problem", "integrator", "precision", "variant"], sort=False):
            traces.append(line(rows, work, symbols[variant]))
        traces.extend(crosses(failed))
        edge = {"overlaying": "x", "range": [0, 1], "visible": False, "fixedrange": True}
        layout = {"xaxis": logarithmic(title), "yaxis": logarithmic("largest error of displacements, relative"), "xaxis2": edge, "yaxis2": {**edge, "overlaying": "y"}}
        marks = ", ".join(f"{symbol.replace('-', ' ')} {variant}" for variant, symbol in symbols.items())
        text = (f"Lower and further left is better. A colour is a method, a line a precision (solid f64, dotted f32, dashed f32c), a mark a variant ({marks}); hollow marks are below ten times "
                f"the solution's own error. {len(good)} points were measured; {len(failed)} failed and stand as crosses at the upper edge.")
        return Chart(text, "work_precision", traces, layout, frame, COLUMNS, FILTERS, height=520)
    return make


against_time = against("measured_wall_s", "median time of a run [s]")
against_evaluations = against("evaluations", "force evaluations x elements")


def pareto(results):
    frame = rows_of(results)
    frame = frame[(frame["pareto"] == "yes") & frame["error_max"].notna()].sort_values("measured_wall_s")
    if frame.empty:
        raise NotMeasured("tables/work_precision.csv has no point on a front")
    symbols = by_order(frame["problem"].unique(), SYMBOLS)
    traces = []
    for name, rows in frame.groupby("problem", sort=False):
        traces.append(points(rows, "work_precision", "measured_wall_s", "error_max", ["problem"], COLUMNS, mode="lines", name=name, showlegend=False, hoverinfo="skip",
                             line={"color": "soft", "width": 2, "shape": "hv"}))
    for (name, method, precision), rows in frame.groupby(["problem", "integrator", "precision"], sort=False):
        traces.append(points(rows, "work_precision", "measured_wall_s", "error_max", ["problem", "integrator", "precision"], COLUMNS, mode="markers", name=method, legendgroup=method,
                             marker={"size": 10, "symbol": symbols[name] + ("" if precision == "f64" else "-open"), "color": colour_of(method), "line": {"width": 2, "color": colour_of(method)}}))
    cheapest = frame.loc[frame.groupby("problem", sort=False)["measured_wall_s"].idxmin()]
    words = "; ".join(f"{row['problem']}: {row['integrator']} in {row['precision']}" for _, row in cheapest.iterrows())
    marks = ", ".join(f"{symbol.replace('-', ' ')} {name}" for name, symbol in symbols.items())
    text = (f"Points that no other one beats both in time and in error: what to take. A colour is a method, a mark a scene ({marks}); hollow marks are in single precision. "
            f"The fastest point that has a correct digit at all is of {words}.")
    layout = {"xaxis": logarithmic("median time of a run [s]"), "yaxis": logarithmic("largest error of displacements, relative")}
    return Chart(text, "work_precision", traces, layout, frame, COLUMNS, [Filter("problem", "Scene"), Filter("integrator", "Method"), Filter("precision", "Precision")])
