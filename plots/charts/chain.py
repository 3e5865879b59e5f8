"""The chain of factors from the reference to the cheapest method of the same error."""
from description import Axis, Chart, Look, Panel, Series, guide
from tables.results import NotMeasured
from tables.words import shown

COLUMNS = {
    "link": "link", "label": "label", "scene": "scene", "set": "set", "variant": "variant",
    "threads": "threads", "model": "model", "precision": "precision", "integrator": "method",
    "dt_s": "step [s]", "measured_wall_s": "median time [s]",
    "factor_of_link": "factor of this link", "factor_vs_reference": "against the reference",
    "factor_vs_reference_low": "from", "factor_vs_reference_high": "to",
    "contaminated": "contaminated repetitions", "repetitions": "of", "error_max": "error",
    "error_bar": "error allowed", "status": "status", "reason": "reason"}


def best_link(frame):
    """The fastest of the links that keep the allowed error; none if none does."""
    within = frame[(frame["status"] == "ok") & (frame["error_max"] <= frame["error_bar"])
                   & frame["factor_vs_reference"].notna()]
    return within.loc[within["factor_vs_reference"].idxmax()] if len(within) else None


def chain(results):
    """Factors as bars, errors below."""
    interval = ["factor_vs_reference_low", "factor_vs_reference_high"]
    frame = results.table("chain", "link", "label", "factor_vs_reference", "status", optional=[
        "factor_of_link", "error_max", "error_bar", *interval]).sort_values("link")
    good = frame[frame["factor_vs_reference"].notna()].copy()
    if good.empty:
        raise NotMeasured("no link of the chain has a factor")
    good["factor"] = [f"x {shown(value)}" if shown(value) else ""
                      for value in good["factor_of_link"]]
    factors = Series("times the reference", good, "label", "factor_vs_reference", Look("#0072B2"),
                     kind="bars", low=interval[0], high=interval[1], label="factor")
    errors = [Series("error", good, "label", "error_max",
                     Look("#D55E00", "diamond", "dot", size=10))]
    if good["error_bar"].notna().any():
        errors.append(guide("error allowed", list(zip(good["label"], good["error_bar"])),
                            Look("soft", line="dash")))
    best = best_link(frame)
    findings = "No link keeps the allowed error." if best is None else (
        "The fastest link within the allowed error is "
        f"{shown(best['factor_vs_reference'])} times the reference ({best['label']}), with an "
        f"error of {shown(best['error_max'])}.")
    heading = ("Each bar is one link more: how many times faster than the reference, all in one "
               "interleaved run; on top, what the link itself brings (each a median of paired "
               "ratios, whose product need not be the whole).")
    x = Axis(scale="category", categories=list(good["label"]))
    lowest = min(0.8, 0.8 * good["factor_vs_reference"].min())
    return Chart("chain", frame, COLUMNS, [
        Panel(x, Axis("times the reference", "log", limits=(lowest, None)), [factors]),
        Panel(x, Axis("error, relative", "log"), errors, 0.7)],
        heading, findings, height=420, size=(1 + 1.1 * len(good), 3.2))
