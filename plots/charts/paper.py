"""The paper's tables as pictures: each figure of a table, published, measured and simulated."""
import pandas
from description import Axis, Chart, Filter, Look, Panel, Series, keys_of
from tables.results import NotMeasured

COLUMNS = {
    "row": "row of the paper", "column": "column", "way": "way", "base": "base", "unit": "unit",
    "paper": "paper", "measured": "measured", "measured_low": "from", "measured_high": "to",
    "simulated_paper_node": "simulated, the paper's node", "ran": "what ran", "machine": "where",
    "steps": "steps", "scaled": "scaled", "repetitions": "repetitions",
    "contaminated": "contaminated", "status": "status"}
LOOKS = {"the base": Look("#999999", "square"), "as the paper did": Look("#0072B2", "circle"),
         "our best": Look("#D55E00", "diamond")}
PAPER, SIMULATED = Look("ink", "line-ns", size=14), Look("#009E73", "triangle-up", is_hollow=True)
BASE = "as_published"


def short(row):
    """A row of the paper in few words."""
    return row.replace("Xeon E5-2650v3", "CPU").replace("NVIDIA ", "")


def of_kind(frame, name, look, value, **interval):
    """A series of the rows that have a value; none if there are none."""
    rows = frame[frame[value].notna()]
    return [Series(name, rows, "place", value, look, **interval)] if len(rows) else []


def series_of(frame):
    """The published figures, those of each way, and the simulated ones."""
    series = of_kind(frame.drop_duplicates("place"), "paper", PAPER, "paper")
    for way, look in LOOKS.items():
        series += of_kind(frame[frame["way"] == way], f"measured: {way}", look, "measured",
                          low="measured_low", high="measured_high")
    ways = frame[frame["way"] == "as the paper did"]
    return series + of_kind(ways, "simulated: as the paper did, nodes as fast as the paper's",
                            SIMULATED, "simulated_paper_node")


def panel_of(frame, title):
    """A panel of times or of speed-ups; none without rows."""
    if frame.empty:
        return []
    x = Axis(scale="category", categories=list(dict.fromkeys(frame["place"])))
    return [Panel(x, Axis(title, "log"), series_of(frame))]


def paper_table(name):
    """A table of the paper, in its order."""
    def make(results):
        frame = results.table(name, "row", "column", "way", "unit", "paper", "status", optional=[
            "base", "measured", "measured_low", "measured_high", "simulated_paper_node", "ran",
            "machine", "steps", "scaled", "repetitions", "contaminated"]).copy()
        if frame["measured"].notna().sum() == 0:
            raise NotMeasured(f"tables/{name}.csv has no measured figure with an interval")
        is_one_row = frame["row"].nunique() == 1
        frame["place"] = [column if is_one_row else f"{short(row)}, {column}"
                          for row, column in zip(frame["row"], frame["column"])]
        shown = frame[frame["base"].isna() | (frame["base"] == BASE)]
        panels = (panel_of(shown[shown["unit"] == "s"], "time [s]")
                  + panel_of(shown[shown["unit"] == "ratio"], f"speed-up over {BASE}"))
        heading = ("The columns of the paper, in its order. A bar: published, on the paper's "
                   "machines. Filled marks: measured here, with 95 % intervals; a time of fewer "
                   "steps is scaled to the paper's. Hollow marks: simulated, a cluster of nodes as "
                   "fast as the paper's. A figure that this machine cannot give is left out; the "
                   "table says why.")
        missing = sorted(set(frame[frame["measured"].isna()]["column"]) - {"T1"})
        findings = f"Not measured here: {', '.join(missing)}." if missing else ""
        return Chart(name, frame, COLUMNS, panels, heading, findings,
                     height=420, size=(max(7, 0.75 * frame["place"].nunique()), 3.4))
    return make


def figure9(results):
    """The times of Table 3 over the side of the plate, as in the paper's figure 9."""
    frame = results.table("paper_figure9", "curve", "set", "way", "paper_s", "status", optional=[
        "measured_s", "measured_low_s", "measured_high_s", "ran", "machine", "scaled"]).copy()
    frame["n"] = pandas.to_numeric(frame["set"].str.extract(r"(\d+)")[0])
    colours = dict(zip(dict.fromkeys(frame["curve"]), ["#0072B2", "#E69F00", "#009E73", "#CC79A7"]))
    series = []
    for curve, rows in frame.groupby("curve", sort=False):
        paper = rows.drop_duplicates("n")
        series.append(Series(f"{curve} (paper)", paper, "n", "paper_s",
                             Look(colours[curve], "circle", "dash", is_hollow=True),
                             keys_of(paper, "curve")))
        for way, mark in (("as the paper did", "square"), ("our best", "diamond")):
            own = rows[(rows["way"] == way) & rows["measured_s"].notna()]
            if len(own):
                series.append(Series(f"{curve}: {way}", own, "n", "measured_s",
                                     Look(colours[curve], mark, "solid"),
                                     keys_of(own, "curve"),
                                     low="measured_low_s", high="measured_high_s"))
    columns = {"curve": "curve", "set": "plate", "way": "way", "paper_s": "paper [s]",
               "measured_s": "measured [s]", "ran": "what ran", "machine": "where",
               "scaled": "scaled", "status": "status"}
    ticks = {n: f"{n}" for n in sorted(frame["n"].unique())}
    heading = ("Time of 10,000 steps over the elements a side. Hollow marks, dashed: published. "
               "Filled marks: measured, with 95 % intervals, scaled if fewer steps ran.")
    return Chart("paper_figure9", frame, columns,
                 [Panel(Axis("elements a side, n", "log", ticks=ticks),
                        Axis("time of 10,000 steps [s]", "log"), series)],
                 heading, "", [Filter("curve", "Curve", opens_with=(
                     " and ".join(list(colours)[:2]), list(colours)[:2]))],
                 size=(7, 5), height=540)
