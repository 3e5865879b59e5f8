"""The chain of factors, from plain code to the cheapest run of the same accuracy."""
from description import Axis, Chart, Look, Panel, Series, guide
from tables.results import NotMeasured
from tables.words import shown

COLUMNS = {
    "stage": "stage", "label": "label", "scene": "scene", "set": "set", "variant": "variant",
    "threads": "threads", "model": "model", "precision": "precision", "integrator": "method",
    "dt_s": "step [s]", "wall_s": "time of the whole run [s]", "scaled": "scaled",
    "factor_of_stage": "factor of this stage", "factor_vs_base": "against the base",
    "factor_vs_base_low": "from", "factor_vs_base_high": "to",
    "contaminated": "contaminated repetitions", "repetitions": "repetitions", "error_max": "error",
    "error_until_s": "error until [s]", "error_bar": "error allowed", "status": "status",
    "reason": "reason"}


def stages_of(frame):
    """The stages, without the neighbours that stand beside them."""
    return frame[frame["role"] == "stage"].sort_values("stage")


def best_stage(frame):
    """The fastest stage that keeps the allowed error, or none."""
    frame = stages_of(frame)
    within = frame[(frame["status"] == "ok") & (frame["error_max"] <= frame["error_bar"])
                   & frame["factor_vs_base"].notna()]
    return within.loc[within["factor_vs_base"].idxmax()] if len(within) else None


def words_of(good, best, beside):
    """(heading, findings) of the chart."""
    base = good["base"].iloc[0]
    heading = (f"A bar is the speed-up of a stage of the chain over {base}, the paper's algorithm "
               "in plain code. The number above it is the factor of the stage itself. All stages "
               "are timed in turn in one run. Each value is a median of paired ratios, so the "
               "factors multiply to the last bar only approximately. Errors are those of the "
               "variant that is timed; a slow stage ran a part of the time.")
    findings = "No stage keeps the allowed error." if best is None else (
        f"The fastest stage within the allowed error is {shown(best['factor_vs_base'])} times "
        f"{base} ({best['label']}), with an error of {shown(best['error_max'])}.")
    if len(beside):
        rows = "; ".join(f"{row['label']}: error {shown(row['error_max'], 2)}, "
                         f"{shown(row['factor_of_stage'])} times its stage"
                         for _, row in beside.iterrows())
        findings += f" A parameter was chosen when the bar was known. Beside it: {rows}."
    return heading, findings


def chain(table):
    """The factors as bars, and the errors below."""
    def make(results):
        interval = ["factor_vs_base_low", "factor_vs_base_high"]
        frame = results.table(table, "stage", "role", "label", "base", "status", optional=[
            "factor_vs_base", "factor_of_stage", "error_max", "error_bar", *interval])
        stages = stages_of(frame)
        good = stages[stages["factor_vs_base"].notna()].copy()
        if good.empty:
            raise NotMeasured("no stage of the chain has a factor: that needs six repetitions")
        good["factor"] = [f"x {shown(value)}" if shown(value) else ""
                          for value in good["factor_of_stage"]]
        factors = Series("times the base", good, "label", "factor_vs_base", Look("#0072B2"),
                         kind="bars", low=interval[0], high=interval[1], label="factor")
        errors = [Series("error", good, "label", "error_max",
                         Look("#D55E00", "diamond", "dot", size=10))]
        if good["error_bar"].notna().any():
            errors.append(guide("error allowed", list(zip(good["label"], good["error_bar"])),
                                Look("soft", line="dash")))
        heading, findings = words_of(good, best_stage(frame), frame[frame["role"] != "stage"])
        x = Axis(scale="category", categories=list(good["label"]))
        lowest = min(0.8, 0.8 * good["factor_vs_base"].min())
        times = Axis(f"times {good['base'].iloc[0]}", "log", limits=(lowest, None))
        return Chart(table, frame, COLUMNS, [
            Panel(x, times, [factors]),
            Panel(x, Axis("error, relative", "log"), errors, 0.7)],
            heading, findings, height=420, size=(1 + 1.1 * len(good), 3.2))
    return make
