"""Where the time of a step goes: kernels and the rest, stacked."""
from ..words import problem, shown
from .chart import OKABE_ITO, Chart, Filter, by_order, linear, points

COLUMNS = {"variant": "variant", "model": "model", "precision": "precision", "problem": "scene", "threads": "threads", "part": "part", "count_per_step": "a step",
           "measured_ns_per_element_step": "ns an element and step", "share_of_step": "share of the step", "share_of_ceiling": "share of its ceiling", "measured_in_l1_ns": "by itself in L1 [ns]",
           "share_of_ceiling_in_l1": "share of its ceiling, in L1", "mix_bound_ns": "bound: its instructions [ns]", "mix_without_stack_bound_ns": "bound: these without the stack [ns]",
           "peak_bound_ns": "bound: its flops [ns]", "traffic_bound_ns": "bound: its bytes [ns]", "limiter": "limiter",
           "sum_over_step": "sum of parts over the step"}
FILTERS = [Filter("variant", "Variant"), Filter("model", "Model"), Filter("precision", "Precision"), Filter("problem", "Scene"), Filter("threads", "Threads")]
KEYS = [one.key for one in FILTERS]
PATTERNS = ["", "/", "x", ".", "-", "|", "+", "\\"]  # parts are told apart without their colours too


def attribution(results):
    frame = results.table("attribution", "variant", "model", "precision", "scene", "n", "threads", "part", "measured_ns_per_element_step", "share_of_step", "limiter", "sum_over_step")
    sums = frame["sum_over_step"].dropna()
    frame = frame[frame["measured_ns_per_element_step"].notna()].copy()
    frame["problem"] = [problem(row["scene"], f"n={shown(row['n'])}" if shown(row["n"]) else "") for _, row in frame.iterrows()]
    frame["bar"] = frame["variant"] + " " + frame["model"] + " " + frame["precision"] + " " + frame["problem"] + ", t" + frame["threads"].map(shown)
    whole = frame["part"] == "step"
    parts = frame[~whole]
    colours, patterns = by_order(parts["part"].unique(), OKABE_ITO), by_order(parts["part"].unique(), PATTERNS)
    traces = []
    for (part, *_), rows in parts.groupby(["part", *KEYS], sort=False, dropna=False):
        trace = points(rows, "attribution", "measured_ns_per_element_step", "bar", KEYS, COLUMNS, type="bar", orientation="h", name=part,
                       legendgroup=part, marker={"color": colours[part], "pattern": {"shape": patterns[part], "fillmode": "overlay", "fgcolor": "ground", "size": 6, "solidity": 0.25}}, textposition="none")
        trace["hovertext"], trace["hovertemplate"] = trace.pop("text"), "%{hovertext}<extra></extra>"
        traces.append(trace)
    for _, rows in frame[whole].groupby(KEYS, sort=False, dropna=False):
        traces.append(points(rows, "attribution", "measured_ns_per_element_step", "bar", KEYS, COLUMNS, mode="markers", name="the step itself",
                             marker={"symbol": "line-ns", "size": 20, "color": "ink", "line": {"width": 3, "color": "ink"}}))
    words = "" if sums.empty else f" The parts add up to {' to '.join(dict.fromkeys(f'{end:.3g}' for end in (sums.min(), sums.max())))} of the step's own time."
    text = ("Time of an element and step, by part; limiters, bounds and shares of ceilings are said by each part. A part below zero (the rest, where the step is faster than its rows by themselves) "
            f"points to the left.{words}")
    bars = frame["bar"].nunique()
    layout = {"barmode": "relative", "xaxis": linear("ns an element and step", rangemode="tozero", zeroline=True), "yaxis": linear("", type="category", autorange="reversed", automargin=True)}
    return Chart(text, "attribution", traces, layout, frame, COLUMNS, FILTERS, height=180 + 30 * bars)
