"""Where errors come from, side by side."""
from ..results import NotMeasured
from .chart import OKABE_ITO, SYMBOLS, Chart, Filter, by_order, linear, logarithmic, points

COLUMNS = {"label": "problem", "source": "source", "error": "error", "error_final": "at the end", "observed_order": "observed order", "status": "status", "reason": "reason", "refined": "kept on all grids"}


def error_budget(results):
    frame = results.table("error_budget", "label", "source", "error", "status")
    good = frame[frame["error"] > 0]
    if good.empty:
        raise NotMeasured("tables/error_budget.csv has no error")
    colours, symbols = by_order(good["label"].unique(), OKABE_ITO), by_order(good["label"].unique(), SYMBOLS)
    traces = [points(rows, "error_budget", "error", "source", ["label"], COLUMNS, mode="markers", name=label, legendgroup=label, marker={"size": 12, "color": colours[label], "symbol": symbols[label]})
              for label, rows in good.groupby("label", sort=False)]
    largest = good.loc[good.groupby("label", sort=False)["error"].idxmax()]
    text = "Errors of one configuration by their source, relative: " + "; ".join(f"of {row['label']} the largest is {row['source']} ({row['error']:.2g})" for _, row in largest.iterrows()) + "."
    layout = {"xaxis": logarithmic("relative error of displacements"), "yaxis": linear("", type="category", autorange="reversed", automargin=True)}
    return Chart(text, "error_budget", traces, layout, frame, COLUMNS, [Filter("label", "Problem")])
