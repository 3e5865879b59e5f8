"""The errors of one configuration by their source."""
from description import Axis, Chart, Filter, Look, Panel, Series, colours_of, keys_of
from tables.results import NotMeasured
from tables.words import is_missing

COLUMNS = {
    "label": "problem", "source": "source", "error": "error", "error_final": "at the end",
    "observed_order": "observed order", "status": "status", "reason": "reason",
    "refined": "kept on all grids"}
KINDS = {"time": "#0072B2", "space": "#D55E00", "rounding": "#009E73", "model": "#E69F00",
         "rotation": "#CC79A7"}
LEAST = 1e-17  # bars begin here; an error of zero has no bar
TICKS = {10.0**power: f"1e{power}" if power else "1" for power in range(-15, 1, 3)}


def words(row):
    """The text beside a bar: the error, its observed order and its status."""
    if is_missing(row["error"]):
        return str(row["status"])
    text = "none" if row["error"] == 0 else f"{row['error']:.1e}"
    if not is_missing(row["observed_order"]) and row["status"] == "ok":
        text += f"  (observed order {row['observed_order']:.2f})"
    return text if row["status"] == "ok" else f"{text}  ({row['status']})"


def source_of(row):
    """The source of an error; an error of time has its step."""
    has_step = row["source"].startswith("time") and not is_missing(row["dt_s"])
    return f"{row['source']} (dt = {row['dt_s']:.3g} s)" if has_step else row["source"]


def error_budget(results):
    """Each problem has a panel, each source a bar."""
    frame = results.table("error_budget", "label", "source", "error", "status",
                          optional=["integrator", "elements", "end_time_s", "observed_order",
                                    "dt_s"])
    good = frame[frame["error"] > 0]
    if good.empty:
        raise NotMeasured("tables/error_budget.csv has no error")
    frame["named"] = [source_of(row) for _, row in frame.iterrows()]
    frame["words"] = [words(row) for _, row in frame.iterrows()]
    frame["kind"] = frame["source"].str.split().str[0]
    frame["is_open"] = frame["status"] == "no limit"
    frame["length"] = frame["error"].fillna(0).clip(lower=LEAST)
    colours, series, titles = colours_of(frame["kind"].unique(), KINDS), [], {}
    for (_, kind, is_open), rows in frame.groupby(["label", "kind", "is_open"], sort=False):
        look = Look(colours[kind], hatch="/" if is_open else "")
        name = f"{kind}, no limit" if is_open else kind
        series.append(Series(name, rows, "length", "named", look, keys_of(rows, "label"),
                             kind="bars", label="words"))
    for label, rows in frame.groupby("label", sort=False):
        first = rows.iloc[0]
        titles[label,] = (f"{label}: {first['integrator']}, {first['elements']:.0f} elements, to "
                          f"{first['end_time_s']:g} s")
    largest = good.loc[good.groupby("label", sort=False)["error"].idxmax()]
    findings = "; ".join(f"{row['label']}: {row['source']} ({row['error']:.2g})"
                         for _, row in largest.iterrows())
    heading = ("Relative errors of one configuration by their source. Hatched: refinement has no "
               "limit; the bar is the difference between the first and the last grid.")
    most = max(rows["source"].nunique() for _, rows in frame.groupby("label"))
    x = Axis("relative error of displacements, largest over the saved times", "log",
             limits=(LEAST, 1e8), ticks=TICKS)  # the labels of bars need room
    y = Axis(scale="category", categories=list(dict.fromkeys(frame["named"])), is_reversed=True)
    return Chart("error_budget", frame, COLUMNS, [Panel(x, y, series)], heading,
                 f"Largest errors: {findings}.",
                 [Filter("label", "Problem", is_single=True)], ("label",), titles=titles,
                 columns_of_facets=1, size=(8, 0.8 + 0.24 * most))
