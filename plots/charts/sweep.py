"""The chart of a sweep: the rate of each cell over the override that has several values."""
import pandas
from description import Axis, Chart, Filter, Panel, Series, keys_of, looks_of
from tables.results import NotMeasured

from . import cells

OTHERS = ["model", "precision", "integrator"]


def swept(frame):
    """(name, numbers) of the override that has several values; the first one, in a table of one
    scene."""
    words = frame["set"].astype(str).str.findall(r"(\S+)=(\S+)").map(dict)
    for name in dict.fromkeys(key for own in words for key in own):
        numbers = pandas.to_numeric(words.map(lambda own: own.get(name)), errors="coerce")
        if numbers.nunique() > 1:
            return name, numbers
    raise NotMeasured("no override has several values")


def line_names(frame):
    """The cell of each row in words, with what else differs between rows of one label."""
    several = [key for key in OTHERS if frame[key].nunique() > 1]
    return frame[["label", *several]].astype(str).agg(", ".join, axis=1)


def rates(table):
    """The rate of each cell over the override that a sweep varies."""
    def make(results):
        ends = "measured_wall_low_s", "measured_wall_high_s"
        frame = results.table(table, *cells.CELL, "scene", "set", optional=[
            *cells.PROBLEM, "element_steps_per_s", "measured_wall_s", *ends, "repetitions"])
        frame = frame[(frame["source"] == "measured") & (frame["status"] == "ok")
                      & frame["element_steps_per_s"].notna() & ~cells.is_pair(frame)].copy()
        name, frame["swept"] = swept(frame)
        frame = frame[frame["swept"].notna()].sort_values("swept", kind="stable")
        frame["rate"] = frame["element_steps_per_s"] / 1e6
        for end, of_time in zip(("low", "high"), reversed(ends)):
            frame[f"rate_{end}"] = frame["rate"] * frame["measured_wall_s"] / frame[of_time]
        frame["line"] = line_names(frame)
        looks = looks_of(frame["line"].unique(), line="solid")
        series = [Series(line, own, "swept", "rate", looks[line], keys_of(own, "label"),
                         low="rate_low", high="rate_high")
                  for line, own in frame.groupby("line", sort=False)]
        ticks = {value: f"{value:g}" for value in sorted(frame["swept"].unique())}
        scale = "log" if frame["swept"].min() > 0 else "linear"
        best = frame.loc[frame["rate"].idxmax()]
        columns = {"line": "cell", "set": "set", "rate": "million element-steps/s",
                   "rate_low": "from", "rate_high": "to", "repetitions": "repetitions"}
        return Chart(table, frame, columns,
                     [Panel(Axis(name, scale, ticks=ticks), Axis("million element-steps/s"),
                            series)],
                     f"The rate over {name}: medians, and their 95 % intervals from six "
                     "repetitions on.",
                     f"The highest is {best['rate']:.3g}: {best['line']}, {best['set']}.",
                     [Filter("label", "Cell")], size=(7, 4.5))
    return make
