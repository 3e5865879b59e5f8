"""The failure atlas: methods by cases, with the expected verdict and its reason."""
import math

from description import Axis, Chart, Filter, Look, Panel, Series, keys_of
from tables.words import is_missing

# Okabe and Ito's colours, and a mark for each verdict.
VERDICTS = {"ok": Look("#009E73", "square"), "inaccurate": Look("#E69F00", "triangle-up"),
            "drifts": Look("#56B4E9", "diamond"), "unstable": Look("#D55E00", "x"),
            "refused": Look("#999999", "circle", is_hollow=True)}
OTHER = Look("ink", "star")
METRICS = {"error": "relative error", "travel_error": "error over distance moved",
           "observed_order": "observed order", "energy_change": "change of energy",
           "energy_trend": "trend of energy", "amplitude": "growth", "tip_gap": "gap at closing",
           "value": "deflection"}
COLUMNS = {
    "case": "case", "method": "method", "set": "set", "precision": "precision",
    "rotation": "rotation", "model": "model", "verdict": "verdict", "expected": "expected",
    "why": "why", "metric_name": "measure", "figure": "figure", "predicted": "predicted",
    "deviation": "figure / predicted - 1", "dt_s": "step [s]", "status": "status",
    "reason": "reason"}
FILTERS = [Filter("verdict", "Verdict"), Filter("expected", "Expected"),
           Filter("precision", "Precision"), Filter("method", "Method"),
           Filter("status", "As theory says")]


def row_of(cell):
    """The row of a cell: its case, and its precision and rotation if they are not the usual."""
    rotation = str(cell["rotation"]).replace("tait_bryan", "angles")
    special = [cell["precision"]] * (cell["precision"] != "f64")
    special += [rotation] * (not is_missing(cell["rotation"]) and rotation != "quaternion")
    return ", ".join([str(cell["case"]).replace("_", " "), *special])


def shown_figure(cells):
    """The worst figure of the cells of one place, in a few letters."""
    if (cells["verdict"] == "refused").all():
        return "refused"
    figures = cells["figure"].dropna()
    if len(figures) < (cells["verdict"] != "refused").sum():
        return "inf"
    is_order = cells["metric"].iloc[0] == "observed_order"
    worst = min(figures) if is_order else max(figures, key=abs)
    if worst == 0 or math.isinf(worst):
        return "0" if worst == 0 else "inf"
    decade = math.floor(math.log10(abs(worst)))
    text = (f"{worst:.2g}" if -3 <= decade < 2 else
            f"{worst:.0f}" if decade == 2 else f"{worst:.0e}")
    return text.replace("e-0", "e-").replace("e+0", "e").replace("e+", "e")


def with_places(frame, rows, methods):
    """Adds places and labels to `frame`: the cells of one row and method share its width.

    @returns the number of cells that share a place
    """
    group = frame.groupby(["row", "method"])
    place, count = group.cumcount(), group["line"].transform("count")
    frame["width"] = 1 / count
    frame["label_x"] = frame["method"].map(methods.index)
    frame["x"] = frame["label_x"] + (place - (count - 1) / 2) / count
    frame["y"] = frame["row"].map(rows.index)
    figures = {names: shown_figure(cells) for names, cells in group}
    frame["number"] = [figures[row["row"], row["method"]] * bool(at == 0)
                       for at, (_, row) in zip(place, frame.iterrows())]
    return count


def atlas(results):
    """Each case has a row, each method a column."""
    frame = results.table("failures", "case", "method", "precision", "metric", "verdict",
                          "expected", "why", "status", optional=["set", "figure", "rotation"])
    frame["figure"] = frame["figure"].astype(float)
    frame["metric_name"] = frame["metric"].map(lambda metric: METRICS.get(metric, metric))
    frame["row"] = [row_of(cell) for _, cell in frame.iterrows()]
    rows, methods = list(dict.fromkeys(frame["row"])), list(dict.fromkeys(frame["method"]))
    count, series = with_places(frame, rows, methods), []
    for names, cells in frame.groupby(["verdict", "expected", "precision", "method", "status"],
                                      sort=False):
        look = VERDICTS.get(names[0], OTHER)
        look = look.but(size=11 if count[cells.index].max() < 4 else 8)
        name = names[0]
        if names[-1] == "failed":
            look, name = look.but(edge="ink"), f"{name}, differs from theory"
        series.append(Series(name, cells, "x", "y", look, keys_of(cells, *[
            one.key for one in FILTERS]), kind="tiles", label="number", width="width"))
    series.sort(key=lambda one: one.look.edge != "")
    wrong, refused = (frame["status"] == "failed").sum(), (frame["verdict"] != "ok").sum()
    heading = ("The verdict of each method on each case. A cell with several variations has a "
               "part for each of them. The number is the figure that gives the verdict; of "
               "several variations it is the worst.")
    findings = (f"{refused} of {len(frame)} cells are not ok; {wrong if wrong else 'none'} "
                f"{'differs' if wrong < 2 else 'differ'} from theory"
                f"{' (thick edge)' if wrong else ''}. Each cell has its verdict, the expected "
                "verdict and the reason.")
    names = [method.replace("_", "\n", 1) for method in methods]
    x = Axis(ticks=dict(enumerate(names)), limits=(-0.6, len(methods) - 0.4), is_at_top=True)
    measures = frame.groupby("row")["metric_name"].first()
    y = Axis(ticks={place: f"{row}: {measures[row]}" for place, row in enumerate(rows)},
             limits=(-0.6, len(rows) - 0.4), is_reversed=True)
    return Chart("failures", frame, COLUMNS, [Panel(x, y, series)], heading, findings, FILTERS,
                 height=160 + 22 * len(rows),
                 size=(3 + 0.75 * len(methods), 0.8 + 0.22 * len(rows)))
