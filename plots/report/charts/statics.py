"""Solvers of states of rest: their time, and how far they are from each other."""
from ..words import problem
from .chart import OKABE_ITO, SYMBOLS, Chart, Filter, by_order, logarithmic, points

COLUMNS = {"problem": "scene", "loads": "loads", "solver": "solver", "model": "model", "unknowns": "unknowns", "wall_s": "time [s]", "iterations": "iterations", "steps": "steps",
           "residual": "residual", "difference": "difference", "bar": "bar", "status": "status", "reason": "reason", "note": "note"}


def statics(results):
    frame = results.table("statics", "scene", "set", "solver", "model", "unknowns", "wall_s", "difference", "bar", "status")
    frame["problem"] = [problem(row["scene"], row["set"]) for _, row in frame.iterrows()]
    colours, symbols, traces = by_order(frame["solver"].unique(), OKABE_ITO), by_order(frame["solver"].unique(), SYMBOLS), []
    for (solver, _, _, _), rows in frame.groupby(["solver", "problem", "model", "status"], sort=False):
        traces.append(points(rows, "statics", "unknowns", "wall_s", ["solver", "problem", "model", "status"], COLUMNS, mode="markers", name=solver, legendgroup=solver,
                             marker={"size": 9, "color": colours[solver], "symbol": symbols[solver]}))
    held = frame.loc[frame["status"] == "passed", "difference"].dropna()
    words = f" {len(held)} comparisons agree within {held.max():.2g} of the largest displacement (bar {frame['bar'].max():g})." if len(held) else ""
    text = f"Time of each solver over the number of unknowns.{words}"
    return Chart(text, "statics", traces, {"xaxis": logarithmic("unknowns"), "yaxis": logarithmic("time [s]")}, frame, COLUMNS,
                 [Filter("problem", "Scene"), Filter("solver", "Solver"), Filter("model", "Model"), Filter("status", "Status")])
