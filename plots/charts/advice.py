"""Advice against truth: errors over tolerances, times over the cheapest, and what is gained."""
from description import Axis, Chart, Filter, Look, Panel, Series, guide, keys_of, looks_of
from tables.words import problem

COLUMNS = {
    "problem": "scene", "tolerance": "tolerance", "model": "model", "integrator": "method",
    "precision": "precision", "variant": "variant", "threads": "threads",
    "true_error": "true error", "error_estimate": "estimated error",
    "measured_wall_s": "median time [s]", "speedup_over_paper": "against the paper's configuration",
    "paper_error": "error of that", "time_over_cheapest": "over the cheapest found",
    "brute_force_runs": "runs of the search", "verdict": "verdict", "status": "status",
    "reason": "reason"}
BAR = 1.5  # times the cheapest


def advice(results):
    """Errors, times over the cheapest and gains, a line a scene."""
    frame = results.table(
        "advise", "scene", "tolerance", "verdict", "status",
        optional=["set", "true_error", "error_estimate", "speedup_over_paper",
                  "time_over_cheapest"])
    frame["problem"] = [problem(row["scene"], row["set"]) for _, row in frame.iterrows()]
    looks = looks_of(frame["problem"].unique(), line="solid", size=10)
    values = "speedup_over_paper", "true_error", "time_over_cheapest"
    gains, errors, times = panels = [], [], []
    for name, rows in frame.groupby("problem", sort=False):
        rows, keys = rows.sort_values("tolerance"), keys_of(rows, "problem")
        for panel, value in zip(panels, values):
            if rows[value].notna().any():
                panel.append(Series(name, rows, "tolerance", value, looks[name], keys))
        estimate = looks[name].but(line="", is_hollow=True, size=15)
        errors.append(Series(f"estimate, {name}", rows, "tolerance", "error_estimate", estimate,
                             keys, entry=""))
    ends, dashed = [frame["tolerance"].min(), frame["tolerance"].max()], Look("soft", line="dash")
    errors.append(guide("tolerance", [(end, end) for end in ends], dashed, entry="tolerance, bar"))
    for panel, height in ((gains, 1), (times, BAR)):
        points = [(end, height) for end in ends]
        panel.append(guide("bar", points, dashed, entry="tolerance, bar"))
    kept = (frame["true_error"] <= frame["tolerance"]).sum()
    most = frame["time_over_cheapest"].max()
    over = (f"what is advised takes at most {most:.3g} times as long as the cheapest that trying "
            "everything found" if most == most else "nothing was held against trying everything")
    heading = ("Advised configurations: how many times faster than the paper's, which may be far "
               "more accurate than was asked for; their true errors (large hollow marks: the "
               "estimates); their times over the cheapest that was found.")
    x = Axis("tolerance", "log", is_reversed=True)
    titles = ("times the paper's configuration", "true error, relative", "time over the cheapest")
    axes = [Axis(title, scale) for title, scale in zip(titles, ("log", "log", "linear"))]
    axes[2].limits = (0.9, max(1.05 * BAR, 1.05 * most if most == most else 0))
    return Chart("advise", frame, COLUMNS,
                 [Panel(x, y, panel) for y, panel in zip(axes, panels)], heading,
                 f"{kept} of {len(frame)} true errors are within their tolerance; {over}.",
                 [Filter("problem", "Scene")], is_side_by_side=True, size=(3.8, 3.6))
