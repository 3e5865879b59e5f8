"""The chart of a sweep: the rate of each cell over the override that has several values."""
import pandas
from description import Axis, Chart, Filter, Panel, Series, keys_of, looks_of
from tables.results import NotMeasured, is_pair

from . import cells

OTHERS = ["scene", "model", "precision", "integrator"]
ENDS = "measured_wall_low_s", "measured_wall_high_s"


def measured_rates(results, table):
    """Rows with a rate, in millions, and the ends of its interval; wrong cells have none."""
    frame = results.table(table, *cells.CELL, optional=[
        *cells.PROBLEM, "check", "element_steps_per_s", "measured_wall_s", *ENDS, "repetitions"])
    frame = frame[(frame["source"] == "measured") & (frame["status"] == "ok")
                  & (frame["check"] != "failed") & frame["element_steps_per_s"].notna()
                  & ~is_pair(frame)].copy()
    frame["rate"] = frame["element_steps_per_s"] / 1e6
    for end, of_time in zip(("low", "high"), reversed(ENDS)):
        frame[f"rate_{end}"] = frame["rate"] * frame["measured_wall_s"] / frame[of_time]
    return frame


def with_swept(frame):
    """(name, rows): the first override with several numbers, which the column `swept` has.

    The column `cell` says in words what else differs between rows.
    """
    words = frame["set"].fillna("").astype(str).str.findall(r"(\S+)=(\S+)").map(dict)
    names = list(dict.fromkeys(key for own in words for key in own))
    for name in names:
        numbers = pandas.to_numeric(words.map(lambda own: own.get(name)), errors="coerce")
        if numbers.nunique() > 1:
            break
    else:
        raise NotMeasured("no override has several values")
    others = pandas.DataFrame({key: words.map(lambda own: f"{key}={own.get(key)}")
                               for key in names if key != name}, index=frame.index)
    parts = pandas.concat([frame["label"], frame[OTHERS], others], axis=1).astype(str)
    several = [key for key in parts if key == "label" or parts[key].nunique() > 1]
    frame = frame.assign(swept=numbers, cell=parts[several].agg(", ".join, axis=1))
    return name, frame[numbers.notna()].sort_values("swept", kind="stable")


def rates(table):
    """The rate of each cell over the override that a sweep varies."""
    def make(results):
        name, frame = with_swept(measured_rates(results, table))
        looks = looks_of(frame["cell"].unique(), line="solid")
        series = [Series(cell, own, "swept", "rate", looks[cell], keys_of(own, "label"),
                         low="rate_low", high="rate_high")
                  for cell, own in frame.groupby("cell", sort=False)]
        ticks = {value: f"{value:g}" for value in sorted(frame["swept"].unique())}
        scale = "log" if frame["swept"].min() > 0 else "linear"
        best = frame.loc[frame["rate"].idxmax()]
        columns = {"cell": "cell", "set": "set", "rate": "million element-steps/s",
                   "rate_low": "from", "rate_high": "to", "repetitions": "repetitions"}
        return Chart(table, frame, columns,
                     [Panel(Axis(name, scale, ticks=ticks), Axis("million element-steps/s"),
                            series)],
                     f"The rate over {name}: medians, and their 95 % intervals from six "
                     "repetitions on.",
                     f"The highest is {best['rate']:.3g}: {best['cell']}, {best['set']}.",
                     [Filter("label", "Cell")], size=(7, 4.5))
    return make
