"""Which models suffice for which scene, and what they cost."""
from model_ladder import COLOURS, LEAST, MOST

from ..results import NotMeasured
from ..words import problem
from .chart import SYMBOLS, Chart, Filter, by_order, linear, logarithmic, points

NEEDED = ["scene", "set", "precision", "model", "wall_s", "error", "tolerance", "verdict", "provable", "why_not", "ends_with", "status"]
COLUMNS = {"problem": "scene", "model": "model", "verdict": "verdict", "error": "error", "tolerance": "tolerance", "wall_s": "time [s]", "provable": "provable", "why_not": "why not",
           "ends_with": "auto ends with", "promotions": "promotions", "status": "status", "reason": "reason"}
# Verdicts differ in their marks too.
VERDICTS = {"sufficient": ("#009E73", "square"), "insufficient": ("#D55E00", "x")}


def rows_of(results):
    frame = results.table("model_ladder", *NEEDED)
    frame["problem"] = [problem(row["scene"], row["set"], row["precision"]) for _, row in frame.iterrows()]
    return frame


def ladder_verdicts(results):
    """Scenes by models: verdicts, and a ring round what auto ends with."""
    frame = rows_of(results)
    models, chosen = frame[frame["model"] != "auto"], frame[(frame["model"] == "auto") & frame["ends_with"].notna()]
    if models.empty:
        raise NotMeasured("tables/model_ladder.csv has no model")
    traces = []
    for (verdict, provable), rows in models.groupby(["verdict", "provable"], sort=False, dropna=False):
        colour, symbol = VERDICTS.get(verdict, ("#5F5F5F", "triangle-up"))
        traces.append(points(rows, "model_ladder", "model", "problem", ["verdict", "provable"], COLUMNS, mode="markers", name=verdict, legendgroup=verdict,
                             marker={"size": 13, "symbol": symbol, "color": colour}))
    if not chosen.empty:
        traces.append(points(chosen, "model_ladder", "ends_with", "problem", [], COLUMNS, mode="markers", name="auto ends with it", marker={"size": 21, "symbol": "circle-open", "color": "ink",
                                                                                                                                         "line": {"width": 2}}))
    order = [model for model in COLOURS if model in set(models["model"])]
    scenes = list(dict.fromkeys(frame["problem"]))
    good = chosen["error"].le(chosen["tolerance"]).sum()
    text = (f"Squares: the model meets the scene's tolerance; crosses: it does not; a ring: what `--model auto` ends with. Auto meets the tolerance on {good} of {len(chosen)} scenes. "
            "Each mark says its error and why the model is not proven to suffice.")
    layout = {"xaxis": linear("", type="category", categoryorder="array", categoryarray=order, side="top"),
              "yaxis": linear("", type="category", categoryorder="array", categoryarray=scenes, autorange="reversed", automargin=True)}
    return Chart(text, "model_ladder", traces, layout, frame, COLUMNS, [Filter("verdict", "Verdict"), Filter("provable", "Provable")], height=140 + 26 * len(scenes))


def ladder_errors(results):
    frame = rows_of(results)
    good = frame[frame["wall_s"].notna() & frame["error"].notna()]
    if good.empty:
        raise NotMeasured("no model was timed")
    good = good.assign(shown_error=good["error"].clip(LEAST, MOST))
    symbols, traces = by_order(["sufficient", "insufficient"], SYMBOLS), []
    for (_, model, verdict), rows in good.groupby(["problem", "model", "verdict"], sort=False):
        colour = "ink" if model == "auto" else COLOURS.get(model, "#5F5F5F")
        traces.append(points(rows, "model_ladder", "wall_s", "shown_error", ["problem", "model", "verdict"], COLUMNS, mode="markers", name=model, legendgroup=model,
                             marker={"size": 15 if model == "auto" else 9, "symbol": "circle-open" if model == "auto" else symbols.get(verdict, "x"), "color": colour, "line": {"width": 2, "color": colour}}))
    text = (f"Error against the spatial oracle over the time of a run, {good['problem'].nunique()} scenes; circles are within the scene's tolerance, squares are not, rings are `--model auto`. "
            f"Errors below {LEAST:g} are drawn there.")
    layout = {"xaxis": logarithmic("time of a run [s]"), "yaxis": logarithmic("relative error")}
    return Chart(text, "model_ladder", traces, layout, good, COLUMNS, [Filter("problem", "Scene"), Filter("model", "Model"), Filter("verdict", "Verdict")])
