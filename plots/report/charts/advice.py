"""What `dssbench advise` gains over the paper's configuration, and what it misses of the cheapest."""
from ..words import problem
from .chart import OKABE_ITO, SYMBOLS, Chart, Filter, by_order, logarithmic, points

COLUMNS = {"problem": "scene", "tolerance": "tolerance", "model": "model", "integrator": "method", "precision": "precision", "variant": "variant", "threads": "threads", "true_error": "true error",
           "error_estimate": "estimated error", "measured_wall_s": "median time [s]", "speedup_over_paper": "against the paper's configuration", "paper_error": "error of that",
           "time_over_cheapest": "over the cheapest found", "brute_force_runs": "runs of the search", "verdict": "verdict", "status": "status", "reason": "reason"}


def advice(results):
    frame = results.table("advise", "scene", "set", "tolerance", "true_error", "speedup_over_paper", "time_over_cheapest", "verdict", "status")
    frame["problem"] = [problem(row["scene"], row["set"]) for _, row in frame.iterrows()]
    colours, symbols, traces = by_order(frame["problem"].unique(), OKABE_ITO), by_order(frame["problem"].unique(), SYMBOLS), []
    for name, rows in frame.groupby("problem", sort=False):
        traces.append(points(rows.sort_values("tolerance"), "advise", "tolerance", "speedup_over_paper", ["problem"], COLUMNS, mode="lines+markers", name=name, legendgroup=name,
                             line={"color": colours[name], "width": 1.3}, marker={"size": 10, "symbol": symbols[name]}))
    kept = (frame["true_error"] <= frame["tolerance"]).sum()
    most = frame["time_over_cheapest"].max()
    over = f"what is advised takes at most {most:.3g} times as long as the cheapest that trying everything found" if most == most else "nothing was held against trying everything"
    text = (f"How many times faster the advised configuration is than the paper's (which may be far more accurate than was asked for). {kept} of {len(frame)} true errors are within their tolerance; "
            f"{over}.")
    return Chart(text, "advise", traces, {"xaxis": logarithmic("tolerance", autorange="reversed"), "yaxis": logarithmic("times the paper's configuration")}, frame, COLUMNS, [Filter("problem", "Scene")])
