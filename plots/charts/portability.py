"""The cascade plot of performance portability.

J. Sewall, S. J. Pennycook, D. Jacobsen, T. Deakin, S. McIntosh-Smith: Interpreting and visualizing
performance portability metrics, P3HPC 2020.
"""
from description import Axis, Chart, Look, Panel, Series, keys_of, looks_of
from tables import portability
from tables.results import NotMeasured


def cascade_of(frame, kind="application"):
    """A chart of portability.efficiencies: each application from its best platform to its worst,
    and its portability beside it. Each problem has a line of panels.

    @throws NotMeasured if no efficiency of this kind is known
    """
    rows, whole = portability.cascade(frame, kind), portability.portabilities(frame, kind)
    if rows.empty:
        raise NotMeasured(f"no efficiency {portability.KINDS[kind]} is known")
    looks = looks_of(rows["application"].unique(), line="solid", size=8)
    falls, bars = [], []
    for (name, application), own in rows.groupby(["problem", "application"], sort=False):
        own = own.assign(line=range(len(own)))
        falls.append(Series(application, own, "place", f"{kind}_efficiency", looks[application],
                            keys_of(own, "problem"), low=f"{kind}_efficiency_low",
                            high=f"{kind}_efficiency_high"))
        score = whole[(whole["problem"] == name) & (whole["application"] == application)]
        bars.append(Series(f"{application} in all", score.assign(line=0), "portability",
                           "application", Look(looks[application].colour),
                           keys_of(score, "problem"), entry="", kind="bars",
                           low="portability_low", high="portability_high", interval_of="x"))
    count = rows["platform"].nunique()
    heading = (f"Left: the speed of each application, {portability.KINDS[kind]}, from its best of "
               f"{count} platforms to its worst. Right: the harmonic mean over all of them, 0 if "
               "one is missing. Intervals: those of both times at their worst.")
    places = Axis("platforms", limits=(0.8, count + 0.2),
                  ticks={place: str(place) for place in range(1, count + 1)})
    most = max(1.0, rows[f"{kind}_efficiency_high"].max())
    names = list(dict.fromkeys(rows["application"]))
    return Chart("", rows, {}, [
        Panel(places, Axis("efficiency", limits=(0, 1.05 * most)), falls),
        Panel(Axis("performance portability", limits=(0, 1.05 * most)),
              Axis(scale="category", categories=names, is_reversed=True), bars)],
        heading, facets=("problem",), is_side_by_side=True, size=(3.6, 2.6))
