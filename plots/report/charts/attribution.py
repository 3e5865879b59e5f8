"""Where the time of a step goes: kernels and the rest, stacked."""
from ..words import problem, shown
from .chart import OKABE_ITO, Chart, Filter, by_order, linear, points

COLUMNS = {"variant": "variant", "model": "model", "precision": "precision", "problem": "scene", "threads": "threads", "part": "part", "count_per_step": "a step",
           "measured_ns_per_element_step": "ns an element and step", "share_of_step": "share of the step", "share_of_ceiling": "share of its ceiling", "limiter": "limiter",
           "sum_over_step": "sum of parts over the step"}
FILTERS = [Filter("variant", "Variant"), Filter("model", "Model"), Filter("precision", "Precision"), Filter("problem", "Scene"), Filter("threads", "Threads")]
PATTERNS = ["", "/", "x", ".", "-", "|", "+", "\\"]  # parts are told apart without their colours too


def attribution(results):
    frame = results.table("attribution", "variant", "model", "precision", "scene", "n", "threads", "part", "measured_ns_per_element_step", "share_of_step", "limiter", "sum_over_step")
    sums = frame["sum_over_step"].dropna()
    frame = frame[(frame["part"] != "step") & frame["measured_ns_per_element_step"].notna()].copy()  # the whole is what its parts stack up to
    frame["problem"] = [problem(row["scene"], f"n={shown(row['n'])}" if shown(row["n"]) else "") for _, row in frame.iterrows()]
    frame["bar"] = frame["variant"] + " " + frame["model"] + " " + frame["precision"] + " " + frame["problem"] + ", t" + frame["threads"].map(shown)
    colours, patterns = by_order(frame["part"].unique(), OKABE_ITO), by_order(frame["part"].unique(), PATTERNS)
    traces = []
    for (part, *_), rows in frame.groupby(["part", "variant", "model", "precision", "problem", "threads"], sort=False, dropna=False):
        trace = points(rows, "attribution", "measured_ns_per_element_step", "bar", ["variant", "model", "precision", "problem", "threads"], COLUMNS, type="bar", orientation="h", name=part,
                       legendgroup=part, marker={"color": colours[part], "pattern": {"shape": patterns[part], "fillmode": "overlay", "fgcolor": "ground", "size": 6, "solidity": 0.25}}, textposition="none")
        trace["hovertext"], trace["hovertemplate"] = trace.pop("text"), "%{hovertext}<extra></extra>"
        traces.append(trace)
    words = "" if sums.empty else f" The parts add up to {' to '.join(dict.fromkeys(f'{end:.3g}' for end in (sums.min(), sums.max())))} of the step's own time."
    text = f"Time of an element and step, by part; limiters and shares of ceilings are said by each part.{words}"
    bars = frame["bar"].nunique()
    layout = {"barmode": "stack", "xaxis": linear("ns an element and step", rangemode="tozero"), "yaxis": linear("", type="category", autorange="reversed", automargin=True)}
    return Chart(text, "attribution", traces, layout, frame, COLUMNS, FILTERS, height=180 + 30 * bars)
