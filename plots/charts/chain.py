"""The chain of factors, from the reference to the cheapest run of the same accuracy."""
from description import Axis, Chart, Look, Panel, Series, guide
from tables.results import NotMeasured
from tables.words import shown

COLUMNS = {
    "stage": "stage", "label": "label", "scene": "scene", "set": "set", "variant": "variant",
    "threads": "threads", "model": "model", "precision": "precision", "integrator": "method",
    "dt_s": "step [s]", "measured_wall_s": "median time [s]",
    "factor_of_stage": "factor of this stage", "factor_vs_reference": "against the reference",
    "factor_vs_reference_low": "from", "factor_vs_reference_high": "to",
    "contaminated": "contaminated repetitions", "repetitions": "repetitions", "error_max": "error",
    "error_bar": "error allowed", "status": "status", "reason": "reason"}


def best_stage(frame):
    """The fastest stage that keeps the allowed error, or none."""
    within = frame[(frame["status"] == "ok") & (frame["error_max"] <= frame["error_bar"])
                   & frame["factor_vs_reference"].notna()]
    return within.loc[within["factor_vs_reference"].idxmax()] if len(within) else None


def chain(results):
    """The factors as bars, and the errors below."""
    interval = ["factor_vs_reference_low", "factor_vs_reference_high"]
    frame = results.table("chain", "stage", "label", "factor_vs_reference", "status", optional=[
        "factor_of_stage", "error_max", "error_bar", *interval]).sort_values("stage")
    good = frame[frame["factor_vs_reference"].notna()].copy()
    if good.empty:
        raise NotMeasured("no stage of the chain has a factor")
    good["factor"] = [f"x {shown(value)}" if shown(value) else ""
                      for value in good["factor_of_stage"]]
    factors = Series("times the reference", good, "label", "factor_vs_reference", Look("#0072B2"),
                     kind="bars", low=interval[0], high=interval[1], label="factor")
    errors = [Series("error", good, "label", "error_max",
                     Look("#D55E00", "diamond", "dot", size=10))]
    if good["error_bar"].notna().any():
        errors.append(guide("error allowed", list(zip(good["label"], good["error_bar"])),
                            Look("soft", line="dash")))
    best = best_stage(frame)
    findings = "No stage keeps the allowed error." if best is None else (
        "The fastest stage within the allowed error is "
        f"{shown(best['factor_vs_reference'])} times the reference ({best['label']}), with an "
        f"error of {shown(best['error_max'])}.")
    heading = ("A bar is the speed-up of a stage of the chain against the reference. The number "
               "above it is the factor of the stage itself. All stages are timed in turn in one "
               "run. Each value is a median of paired ratios, so the factors multiply to the last "
               "bar only approximately.")
    x = Axis(scale="category", categories=list(good["label"]))
    lowest = min(0.8, 0.8 * good["factor_vs_reference"].min())
    return Chart("chain", frame, COLUMNS, [
        Panel(x, Axis("times the reference", "log", limits=(lowest, None)), [factors]),
        Panel(x, Axis("error, relative", "log"), errors, 0.7)],
        heading, findings, height=420, size=(1 + 1.1 * len(good), 3.2))
