"""How lattices approach beam and plate theory."""
from .chart import OKABE_ITO, SYMBOLS, Chart, Filter, by_order, logarithmic, points

COLUMNS = {"check": "check", "mode": "mode", "elements": "elements", "spacing_m": "spacing [m]", "figure": "figure", "theory": "theory", "error": "error", "order": "order", "bar": "bar", "status": "status",
           "source": "source"}


def continuum(results):
    frame = results.table("continuum", "check", "mode", "elements", "error", "bar", "status")
    frame["size"], frame["mode"] = frame["error"].abs(), frame["mode"].map(lambda mode: "" if mode != mode else f"{mode:g}")
    colours, symbols, traces = by_order(frame["check"].unique(), OKABE_ITO), by_order(frame["check"].unique(), SYMBOLS), []
    for (check, _), rows in frame.groupby(["check", "mode"], sort=False):
        traces.append(points(rows.sort_values("elements"), "continuum", "elements", "size", ["check"], COLUMNS, mode="lines+markers", name=check.replace("_", " "), legendgroup=check,
                             line={"color": colours[check], "width": 1.3}, marker={"size": 8, "symbol": symbols[check]}))
    passed = frame[frame["status"] == "passed"]
    finest = frame.loc[frame.groupby(["check", "mode"])["elements"].idxmax(), "error"].abs().max()
    words = f"; on the finest grids the largest difference is {100 * finest:.2g} %" if finest == finest else ""
    text = (f"Figure over theory less 1, by the number of elements, one line a check and mode: {len(passed)} rows are held to a bar, of {frame['check'].nunique()} checks{words}.")
    return Chart(text, "continuum", traces, {"xaxis": logarithmic("elements"), "yaxis": logarithmic("size of the difference to theory, relative")}, frame, COLUMNS, [Filter("check", "Check")], height=560)
