"""Lattices under refinement: their difference to beam and plate theory."""
from description import (MARKS, Axis, Chart, Filter, Look, Panel, Series, by_order, colours_of,
                         guide, keys_of)
from tables.words import choice

COLUMNS = {
    "check": "check", "mode": "mode", "elements": "elements", "spacing_m": "spacing [m]",
    "figure": "figure", "theory": "theory", "error": "error", "order": "order",
    "richardson_order": "Richardson's order", "bar": "bar", "status": "status",
    "source": "source"}


def guides_of(rows, keys):
    """A line with a slope of two, and the bar over the refinements that must meet it."""
    fine, coarse = rows["spacing_m"].min(), rows["spacing_m"].max()
    top = 1.8 * rows.loc[rows["spacing_m"] == coarse, "size"].max()
    yield guide("slope of two", [(fine, top * (fine / coarse) ** 2), (coarse, top)],
                Look("soft", line="solid", width=1), keys=keys)
    held = rows[rows["value"] >= rows["bar_at"]]
    if not held.empty:
        ends = held["spacing_m"].min(), held["spacing_m"].max()
        yield guide("bar", [(end, held["bar"].iloc[0]) for end in ends],
                    Look("ink", line="dash", width=1), keys=keys)


def continuum(results):
    """The difference to theory; each check has a panel, each mode a line."""
    frame = results.table("continuum", "check", "spacing_m", "elements", "error", "status",
                          optional=["mode", "bar", "bar_at", "value", "figure",
                                    "richardson_limit", "richardson_order"])
    frame["size"] = frame["error"].abs()
    frame["mode"] = frame["mode"].map(lambda mode: choice(mode) if mode == mode else "")
    frame["to_limit"] = (frame["figure"] / frame["richardson_limit"].groupby(
        [frame["check"], frame["mode"]]).transform("first") - 1).abs()
    names = sorted(frame["mode"].unique())
    colours, marks = colours_of(names), by_order(names, MARKS)
    modes, to_limits, guides, titles = [], [], [], {}
    for check, own in frame.groupby("check", sort=False):
        orders, keys = [], keys_of(own, "check")
        for mode, rows in own.groupby("mode", sort=True):
            rows = rows.sort_values("spacing_m")
            name = f"mode {mode}" if mode else "no modes"
            look = Look(colours[mode], marks[mode], "solid", size=10 - 2 * names.index(mode) % 8)
            modes.append(Series(name, rows, "spacing_m", "size", look, keys))
            if rows["to_limit"].iloc[1:].notna().any():
                to_limits.append(Series(f"{name}, own limit", rows.iloc[1:], "spacing_m",
                                        "to_limit", look.but(line="dot", is_hollow=True, size=9),
                                        keys, entry="against the lattice's own limit"))
                orders.append(f"{rows['richardson_order'].dropna().iloc[0]:.2f}"
                              if rows["richardson_order"].notna().any() else "-")
        guides += guides_of(own, keys)
        has_failed = bool((own["status"] == "failed").any())
        titles[keys["check"],] = (f"{check.replace('_', ' ')}\norder {', '.join(orders) or '-'}"
                                  f"{'  FAILED' * has_failed}")
    passed = frame[frame["status"] == "passed"]
    finest = frame.loc[frame.groupby(["check", "mode"])["elements"].idxmax(), "size"].max()
    words = (f" The largest difference on the finest grids is {100 * finest:.2g} %."
             if finest == finest else "")
    heading = ("Relative difference between the lattice and theory, over the edge of an element. A "
               "line is a mode. Hollow marks: difference to the lattice's own limit, which "
               "Richardson's extrapolation finds from the three finest grids; its order is in the "
               "title. Dashed: the bar, over the grids that must meet it.")
    x = Axis("edge of an element [m]", "log", limits=(0.012, 0.32),
             ticks={tick: f"{tick:g}" for tick in (0.02, 0.05, 0.1, 0.2)})
    return Chart("continuum", frame, COLUMNS,
                 [Panel(x, Axis("difference to theory, relative", "log"),
                        modes + to_limits + guides)], heading,
                 f"{len(passed)} rows of {frame['check'].nunique()} checks meet their bar.{words}",
                 [Filter("check", "Check", is_single=True)], ("check",),
                 titles=titles, size=(3.3, 2.7), height=520)
