"""The model ladder: which models suffice for a scene, and what they cost."""
from description import (Axis, Chart, Filter, Look, Panel, Series, colours_of, guide, keys_of)
from tables.results import NotMeasured
from tables.words import is_missing, problem

# From the least work to the most.
COLOURS = {"axial": "#56B4E9", "bending": "#E69F00", "membrane": "#999999", "planar": "#009E73",
           "linear": "#CC79A7", "small": "#D55E00", "spatial": "#0072B2"}
MARKS = {"axial": "triangle-up", "bending": "square", "membrane": "diamond", "planar": "circle",
         "linear": "triangle-down", "small": "pentagon", "spatial": "star"}
COLUMNS = {
    "problem": "scene", "model": "model", "verdict": "verdict", "error": "error",
    "tolerance": "tolerance", "wall_s": "time [s]", "provable": "provable", "why_not": "why not",
    "ends_with": "last model of auto", "promotions": "promotions", "status": "status",
    "reason": "reason"}
VERDICTS = {"sufficient": Look("#009E73", "square", size=13),
            "insufficient": Look("#D55E00", "x", size=13)}
OTHER = Look("#5F5F5F", "triangle-up", size=13)
RING = Look("ink", "circle", is_hollow=True, size=21)
LEAST, MOST = 1e-17, 1e3  # errors beyond these limits are drawn at them


def rows_of(results):
    """Rows with the name of their problem."""
    frame = results.table("model_ladder", "scene", "model", "tolerance", "verdict", "status",
                          optional=["set", "precision", "wall_s", "error", "provable", "why_not",
                                    "ends_with", "promotions", "steps"])
    frame["problem"] = [problem(row["scene"], row["set"], row["precision"])
                        for _, row in frame.iterrows()]
    return frame


def in_order(names):
    """Each name once, from the least work to the most; models that are not in COLOURS are last."""
    return sorted(set(names), key=lambda name: ([*COLOURS, name].index(name), name))


def verdicts(results):
    """The verdicts of models on scenes, and a ring round the last model of `auto`."""
    frame = rows_of(results)
    models = frame[frame["model"] != "auto"]
    chosen = frame[(frame["model"] == "auto") & frame["ends_with"].notna()]
    if models.empty:
        raise NotMeasured("tables/model_ladder.csv has no model")
    series = []
    for names, rows in models.groupby(["verdict", "provable"], sort=False, dropna=False):
        series.append(Series(names[0], rows, "model", "problem", VERDICTS.get(names[0], OTHER),
                             keys_of(rows, "verdict", "provable")))
    if not chosen.empty:
        series.append(Series("last model of auto", chosen, "ends_with", "problem", RING))
    order = in_order(models["model"])
    scenes = list(dict.fromkeys(frame["problem"]))
    good = chosen["error"].le(chosen["tolerance"]).sum()
    heading = ("A square: the model meets the tolerance of the scene. A cross: it does not. A "
               "ring: the last model of `--model auto`.")
    findings = (f"`--model auto` meets the tolerance on {good} of {len(chosen)} scenes. Each mark "
                "has its error, and the reason if the model is not proven to suffice.")
    x = Axis(scale="category", categories=order, is_at_top=True)
    y = Axis(scale="category", categories=scenes, is_reversed=True)
    return Chart("model_ladder", frame, COLUMNS, [Panel(x, y, series)], heading, findings,
                 [Filter("verdict", "Verdict"), Filter("provable", "Provable")],
                 height=140 + 26 * len(scenes), size=(7.5, 0.8 + 0.26 * len(scenes)))


def series_of(frame):
    """Points of models; a model without a time, which lacks degrees of freedom, is at the left."""
    colours = colours_of(frame["model"].unique(), COLOURS)
    for (_, model, verdict), rows in frame.groupby(["problem", "model", "verdict"], sort=False):
        if model == "auto":
            name, look = model, RING.but(size=17)
        else:
            look = Look(colours[model], MARKS.get(model, "x"), size=9)
            is_good = verdict == "sufficient"
            name = model if is_good else f"{model}, {verdict}"
            look = look.but(is_hollow=not is_good)
        keys = keys_of(rows, "problem", "model", "verdict")
        side = 0.03 + 0.045 * (list(COLOURS).index(model) if model in COLOURS else 0)
        for is_timed, own in rows.groupby(rows["wall_s"].notna()):
            own = own.assign(place=own["wall_s"] if is_timed else side)
            yield Series(name, own, "place", "shown_error", look, keys, entry=model,
                         edge="" if is_timed else "left")


def errors(results):
    """Error against time; each scene has a panel."""
    frame = rows_of(results)
    if frame["wall_s"].isna().all():
        raise NotMeasured("no model was timed")
    frame["shown_error"] = frame["error"].fillna(MOST).clip(LEAST, MOST)
    series, titles = list(series_of(frame)), {}
    for name, rows in frame.groupby("problem", sort=False):
        times = rows["wall_s"].dropna()
        ends = [(times.min() / 3, rows["tolerance"].iloc[0]),
                (times.max() * 1.5, rows["tolerance"].iloc[0])]
        series.append(guide("tolerance", ends, Look("soft", line="dash", width=1), entry="",
                            keys={"problem": name}))
        auto = rows[rows["model"] == "auto"]
        titles[name,] = name if auto.empty or is_missing(auto.iloc[0]["ends_with"]) else (
            f"{name}: {auto.iloc[0]['ends_with']}"
            f"{', promoted' * bool((auto['promotions'] > 0).any())}")
    colours = colours_of(frame["model"].unique(), COLOURS)
    legend = [(model, Look(colours[model], MARKS.get(model, "x"), size=9))
              for model in in_order(frame["model"]) if model != "auto"]
    legend += [("does not suffice", Look("soft", "circle", is_hollow=True, size=9)),
               ("auto", RING.but(size=17)), ("tolerance", Look("soft", line="dash", width=1))]
    heading = ("Error against the spatial oracle, over the time of a run. The title has the last "
               "model of `--model auto`. Filled marks are within the tolerance of the scene, "
               "hollow marks are not; the dashed line is that tolerance. Models that lack degrees "
               "of freedom were not timed and stand at the left edge. Errors beyond "
               f"{LEAST:g} and {MOST:g} are drawn at these limits.")
    y = Axis("relative error", "log", limits=(LEAST / 3, 30 * MOST))
    panel = Panel(Axis("time of a run [s]", "log"), y, series)
    return Chart("model_ladder", frame, COLUMNS, [panel], heading,
                 f"There are {frame['problem'].nunique()} scenes.",
                 [Filter("problem", "Scene", is_single=True), Filter("model", "Model"),
                  Filter("verdict", "Verdict")], ("problem",), titles=titles, legend=legend,
                 columns_of_facets=5, size=(2.9, 2.2))
