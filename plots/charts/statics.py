"""Solvers of states of rest: their times, and their differences to Newton's method."""
from description import Axis, Chart, Filter, Look, Panel, Series, guide, keys_of, looks_of
from tables.results import NotMeasured
from tables.words import problem

COLUMNS = {
    "problem": "scene", "loads": "loads", "solver": "solver", "model": "model",
    "unknowns": "unknowns", "wall_s": "time [s]", "iterations": "iterations", "steps": "steps",
    "residual": "residual", "difference": "difference", "bar": "bar", "status": "status",
    "reason": "reason", "note": "note"}
LEAST = 1e-16  # a smaller difference is drawn here


def statics(results):
    """Time over the number of unknowns, and difference over time."""
    frame = results.table("statics", "scene", "solver", "unknowns", "status", optional=[
        "set", "model", "loads", "wall_s", "difference", "bar"])
    frame["problem"] = [problem(row["scene"], row["set"]) for _, row in frame.iterrows()]
    timed = frame[frame["wall_s"].notna()]
    if timed.empty:
        raise NotMeasured("no solver was timed")
    timed = timed.assign(gap=timed["difference"].clip(lower=LEAST))
    looks, times, gaps = looks_of(frame["solver"].unique(), size=9), [], []
    for (solver, _, _, status), rows in timed.groupby(["solver", "problem", "model", "status"],
                                                      sort=False, dropna=False):
        keys = keys_of(rows, "solver", "problem", "model", "status")
        times.append(Series(solver, rows, "unknowns", "wall_s", looks[solver], keys))
        rows = rows[rows["gap"].notna() & (rows["solver"] != "newton")]
        if rows.empty:
            continue
        is_linear = status == "linear"
        look = looks[solver].but(is_hollow=is_linear)
        gaps.append(Series(f"{solver}, linear" if is_linear else solver, rows, "wall_s", "gap",
                           look, keys, entry=solver))
    if frame["bar"].notna().any():
        ends = [(timed["wall_s"].min(), frame["bar"].max()),
                (timed["wall_s"].max(), frame["bar"].max())]
        gaps.append(guide("bar", ends, Look("ink", line="dash")))
    held = frame.loc[frame["status"] == "passed", "difference"].dropna()
    failed = int((frame["status"] == "failed").sum())
    words = (f"{len(held)} comparisons agree within {held.max():.2g} of the largest displacement "
             f"(bar {frame['bar'].max():g})." if len(held) else "")
    heading = ("Left: the time of each solver. Right: the difference between its displacements and "
               "those of Newton's method. Hollow marks: linear equations at loads that are not "
               f"small; they need not meet the bar. {failed or 'No'} "
               f"comparison{'s' * (failed > 1)} failed.")
    panels = [Panel(Axis("unknowns", "log"), Axis("time of a solution [s]", "log"), times),
              Panel(Axis("time of a solution [s]", "log"),
                    Axis("largest difference to Newton's, relative", "log"), gaps)]
    return Chart("statics", frame, COLUMNS, panels, heading, words, [
        Filter("problem", "Scene"), Filter("solver", "Solver"), Filter("model", "Model"),
        Filter("status", "Status")], is_side_by_side=True, size=(4.6, 4))
