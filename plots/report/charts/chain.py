"""The chain of factors from the reference to the cheapest method of the same error."""
from ..results import NotMeasured
from ..words import shown
from .chart import Chart, linear, logarithmic, points, whiskers

COLUMNS = {"link": "link", "label": "label", "scene": "scene", "set": "set", "variant": "variant", "threads": "threads", "model": "model", "precision": "precision", "integrator": "method",
           "dt_s": "step [s]", "measured_wall_s": "median time [s]", "factor_of_link": "factor of this link", "factor_vs_reference": "against the reference",
           "factor_vs_reference_low": "from", "factor_vs_reference_high": "to", "contaminated": "contaminated repetitions", "repetitions": "of", "error_max": "error", "error_bar": "error allowed", "status": "status", "reason": "reason"}


def best_link(frame):
    """The fastest of the links that keep the allowed error; none if none does."""
    within = frame[(frame["status"] == "ok") & (frame["error_max"] <= frame["error_bar"]) & frame["factor_vs_reference"].notna()]
    return within.loc[within["factor_vs_reference"].idxmax()] if len(within) else None


def chain(results):
    frame = results.table("chain", "link", "label", "factor_of_link", "factor_vs_reference", "factor_vs_reference_low", "factor_vs_reference_high", "error_max", "error_bar", "status").sort_values("link")
    good = frame[frame["factor_vs_reference"].notna()]
    if good.empty:
        raise NotMeasured("no link of the chain has a factor")
    labels = [str(label) for label in good["label"]]
    factors = points(good, "chain", "label", "factor_vs_reference", [], COLUMNS, type="bar", name="times the reference", marker={"color": "#0072B2"},
                     error_y=whiskers(good, "factor_vs_reference", "factor_vs_reference_low", "factor_vs_reference_high"))
    # Bars carry no hover text of their own beside what stands on them.
    factors["hovertext"], factors["hovertemplate"] = factors["text"], "%{hovertext}<extra></extra>"
    factors["text"] = [f"x {shown(value)}" if shown(value) else "" for value in good["factor_of_link"]]
    factors["textposition"] = "outside"
    errors = points(good, "chain", "label", "error_max", [], COLUMNS, mode="lines+markers", name="error (right)", yaxis="y2", marker={"color": "#D55E00", "size": 9, "symbol": "diamond"},
                    line={"color": "#D55E00", "dash": "dot"})
    traces = [factors, errors]
    if good["error_bar"].notna().any():
        traces.append({"type": "scatter", "x": labels, "y": [float(value) if value == value else None for value in good["error_bar"]], "mode": "lines", "yaxis": "y2", "name": "error allowed (right)",
                       "line": {"color": "soft", "dash": "dash"}, "meta": {}, "hoverinfo": "skip"})
    best = best_link(frame)
    words = "No link keeps the allowed error." if best is None else (f"The fastest link within the allowed error is {shown(best['factor_vs_reference'])} times the reference ({best['label']}), "
                                                                     f"with an error of {shown(best['error_max'])}.")
    text = f"Each bar is one link more: how many times faster than the reference, all in one interleaved run; on top, what the link itself brings (each a median of paired ratios, whose product need not be the whole). {words}"
    layout = {"xaxis": linear("", type="category", automargin=True), "yaxis": logarithmic("times the reference"), "yaxis2": logarithmic("error, relative", overlaying="y", side="right", showgrid=False)}
    return Chart(text, "chain", traces, layout, frame, COLUMNS, height=540)
