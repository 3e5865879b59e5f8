"""Error against time and against evaluations, and the points of the Pareto fronts."""
from description import (MARKS, PRECISION_LINES, Axis, Chart, Filter, Look, Panel, Series, by_order,
                         colours_of, guide, keys_of, marks_in_words)
from tables.results import NotMeasured
from tables.words import problem

# dopri5 adaptive has a shade of dopri5, smoothed_verlet one of velocity_verlet.
COLOURS = {"rk4": "#0072B2", "velocity_verlet": "#D55E00", "midpoint": "#009E73",
           "symplectic_euler": "#CC79A7", "dopri5": "#E69F00", "dopri5 adaptive": "#8B6100",
           "rkc2": "#56B4E9", "implicit_midpoint": "ink", "smoothed_verlet": "#7A1F00"}
# The reason why a point has no error.
EDGE = {"refused": "above the stability limit", "unstable": "unstable",
        "inaccurate": "no correct digit", "wrong": "wrong", "failed": "failed"}
COLUMNS = {
    "problem": "scene", "integrator": "method", "precision": "precision", "variant": "variant",
    "dt_s": "step [s]", "rtol": "tolerance of steps", "error_max": "largest error",
    "measured_wall_s": "median time [s]", "evaluations": "evaluations x elements",
    "pareto": "on the front", "status": "status", "reason": "reason"}
KEYS = ["problem", "variant", "precision", "integrator"]
MOST_METHODS = 6  # that a chart opens with; the front and the failed points have entries too
INTERVAL = "measured_wall_low_s", "measured_wall_high_s"
TIME = Axis("median time of a run [s]", "log")
EVALUATIONS = Axis("force evaluations x elements", "log")
ERROR = Axis("largest error of displacements,\nrelative", "log")
FRONT = Look("soft", line="solid", width=7, opacity=0.35, is_step=True)


def rows_of(results, table):
    """Rows with the name of their problem; a method with adaptive steps has its own name."""
    frame = results.table(table, "scene", "variant", "precision", "integrator", "status",
                          optional=["set", "end_time_s", "dt_s", "rtol", "error_max",
                                    "measured_wall_s", *INTERVAL, "evaluations", "pareto",
                                    "reason", "below_reference"])
    frame.loc[frame["rtol"].notna(), "integrator"] += " adaptive"
    frame["problem"] = [problem(row["scene"], row["set"]) for _, row in frame.iterrows()]
    frame["is_hollow"] = frame["below_reference"] == "yes"
    return frame


def filters_of(frame):
    """The filters; the page opens with the methods that have most points on the fronts."""
    on_front = frame[frame["pareto"] == "yes"]["integrator"].value_counts()
    methods = list(on_front.index[:MOST_METHODS])
    opens_with = ()
    if 0 < len(methods) < frame["integrator"].nunique():
        opens_with = ("most on the fronts", methods)
    return [Filter("problem", "Scene", is_single=True), Filter("variant", "Variant"),
            Filter("precision", "Precision"), Filter("integrator", "Method", opens_with=opens_with)]


def failed_at_edge(failed, colours):
    """Crosses at the upper edge, for points without an error."""
    for _, own in failed.groupby("problem", sort=False):
        for place, (names, rows) in enumerate(own.groupby(KEYS, sort=False)):
            rows = rows.assign(edge_x=0.02 + 0.03 * (place % 30))
            look = Look(colours[names[-1]], "x-thin", size=9)
            yield Series("failed: at the edge, " + names[-1], rows, "edge_x", "error_max", look,
                         keys_of(rows, *KEYS), entry="failed: at the edge", edge="top")


def legend_of(frame, colours, marks):
    """The meanings of colours, of lines and of marks."""
    methods = [name for name in colours if name in set(frame["integrator"])]
    entries = [(name, Look(colours[name], line="solid", width=2.4)) for name in methods]
    entries += [(name, Look("soft", line=line)) for name, line in PRECISION_LINES.items()
                if name in set(frame["precision"])]
    entries += list(marks.items())
    if (frame["pareto"] == "yes").any():
        entries.append(("Pareto front", FRONT))
    if frame["status"].isin(EDGE).any():
        entries.append(("failed: at the edge", Look("soft", "x-thin", size=9)))
    if frame["is_hollow"].any():
        entries.append(("below 10 x the\nsolution's own error", Look("soft", "circle",
                                                                     is_hollow=True)))
    return entries


def against(table, work, axis):
    """The chart of error against `work`, a column. axis: of the work"""
    def make(results):
        frame = rows_of(results, table)
        good, failed = frame[frame["status"] == "ok"], frame[frame["status"].isin(EDGE)]
        has_work = good[work].notna() & good["error_max"].notna()
        if not has_work.any():
            raise NotMeasured("no point has an error")
        colours, series = colours_of(frame["integrator"].unique(), COLOURS), []
        marks = {name: Look("soft", mark) for name, mark in
                 by_order(good["variant"].unique(), MARKS).items()}
        has_interval = work == "measured_wall_s"
        for _, rows in good[good["pareto"] == "yes"].groupby("problem", sort=False):
            if has_interval:
                series.append(Series("Pareto front", rows.sort_values(work), work, "error_max",
                                     FRONT, keys_of(rows, "problem")))
        for (_, variant, precision, method), rows in good[has_work].groupby(KEYS, sort=False):
            look = marks[variant].but(colour=colours[method],
                                      line=PRECISION_LINES.get(precision, "dashdot"))
            low, high = INTERVAL if has_interval else ("", "")
            series.append(Series(f"{method}, {precision}, {variant}",
                                 rows.sort_values(["dt_s", "rtol"]), work, "error_max", look,
                                 keys_of(rows, *KEYS), entry=method, low=low, high=high,
                                 interval_of="x", hollow="is_hollow"))
        series += failed_at_edge(failed, colours)
        heading = ("Lower and further left is better. A colour is a method, a line a precision "
                   "(solid f64, dotted f32, dashed f32c), a mark a variant "
                   f"({marks_in_words(marks)}). Hollow marks: the error is below ten times the "
                   "error of the solution it is compared with.")
        findings = (f"{len(good)} points were measured. {len(failed)} points failed; they are "
                    "crosses at the upper edge.")
        titles = {(name,): f"{name}, to {rows['end_time_s'].iloc[0]:g} s"
                  for name, rows in frame.groupby("problem", sort=False)}
        rows = frame.assign(status=frame["status"].replace(EDGE))
        return Chart(table, rows, COLUMNS, [Panel(axis, ERROR, series)], heading, findings,
                     filters_of(frame), ("problem",), titles=titles, height=520, size=(4.3, 2.9),
                     legend=legend_of(frame, colours, marks), is_side_by_side=True)
    return make


def against_time(table):
    """Error against the time of a run."""
    return against(table, "measured_wall_s", TIME)


def against_evaluations(table):
    """Error against the number of force evaluations."""
    return against(table, "evaluations", EVALUATIONS)


def pareto(results):
    """The Pareto fronts of all scenes."""
    frame = rows_of(results, "work_precision")
    frame = frame[(frame["pareto"] == "yes") & frame["error_max"].notna()]
    frame = frame.sort_values("measured_wall_s")
    if frame.empty:
        raise NotMeasured("tables/work_precision.csv has no point on a front")
    marks = {name: Look("soft", mark, size=10) for name, mark in
             by_order(frame["problem"].unique(), MARKS).items()}
    colours = colours_of(frame["integrator"].unique(), COLOURS)
    series = [guide(f"front of {name}", rows[["measured_wall_s", "error_max"]].to_numpy(),
                    Look("soft", line="solid", width=2, is_step=True), entry="",
                    keys=keys_of(rows, "problem"))
              for name, rows in frame.groupby("problem", sort=False)]
    for one in series:
        one.name = "front"
    names = ["problem", "integrator", "precision"]
    for (name, method, precision), rows in frame.groupby(names, sort=False):
        is_single = precision != "f64"
        look = marks[name].but(colour=colours[method], is_hollow=is_single)
        series.append(Series(f"{name}, {method}{', single' * is_single}", rows, "measured_wall_s",
                             "error_max", look, keys_of(rows, *names), entry=method))
    cheapest = frame.loc[frame.groupby("problem", sort=False)["measured_wall_s"].idxmin()]
    words = "; ".join(f"{row['problem']}: {row['integrator']} in {row['precision']}"
                      for _, row in cheapest.iterrows())
    heading = ("Pareto fronts: no other point is better both in time and in error. A colour is a "
               f"method, a mark a scene ({marks_in_words(marks)}). Hollow marks are in single "
               "precision.")
    findings = f"The fastest points with a correct digit are, by scene: {words}."
    legend = [(method, Look(colours[method], line="solid", width=2.4))
              for method in frame["integrator"].unique()]
    return Chart("work_precision", frame, COLUMNS, [Panel(TIME, ERROR, series)], heading, findings,
                 [Filter("problem", "Scene"), Filter("integrator", "Method"),
                  Filter("precision", "Precision")], legend=legend + list(marks.items()),
                 size=(7, 5))
