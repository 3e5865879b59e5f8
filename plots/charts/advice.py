"""The configurations that `dssbench advise` names: their errors, their times and their gains."""
from description import Axis, Chart, Filter, Look, Panel, Series, guide, keys_of, looks_of
from tables.words import problem

COLUMNS = {
    "problem": "scene", "tolerance": "tolerance", "model": "model", "integrator": "method",
    "precision": "precision", "variant": "variant", "threads": "threads",
    "true_error": "true error", "error_estimate": "estimated error",
    "measured_wall_s": "median time [s]", "speedup_over_paper": "against the paper's configuration",
    "paper_error": "error of the paper's", "time_over_cheapest": "over the cheapest found",
    "brute_force_runs": "runs of the search", "verdict": "verdict", "status": "status",
    "reason": "reason"}
BAR = 1.5  # largest allowed ratio to the cheapest time


def advice(results):
    """Gains, errors and times over tolerances; each scene has a line."""
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
    errors.append(guide("tolerance", [(end, end) for end in ends], dashed, entry="limit"))
    for panel, height in ((gains, 1), (times, BAR)):
        points = [(end, height) for end in ends]
        panel.append(guide("bar", points, dashed, entry="limit"))
    kept = (frame["true_error"] <= frame["tolerance"]).sum()
    most = frame["time_over_cheapest"].max()
    over = (f"the advised configuration takes at most {most:.3g} times the cheapest time of a full "
            "search" if most == most else "no full search was made")
    heading = ("Advised configurations. Left: the speed-up against the paper's configuration, "
               "which may be far more accurate than the tolerance. Middle: the true error; large "
               "hollow marks are estimates. Right: the time over the cheapest time of a full "
               "search. Dashed: equal speed, the tolerance, and the largest allowed ratio.")
    ticks = {tolerance: f"{tolerance:.0e}" for tolerance in sorted(frame["tolerance"].unique())}
    x = Axis("tolerance", "log", ticks=ticks, is_reversed=True)
    titles = ("speed-up against the paper's", "true error, relative", "time over the cheapest")
    axes = [Axis(title, scale) for title, scale in zip(titles, ("log", "log", "linear"))]
    axes[2].limits = (0.9, max(1.05 * BAR, 1.05 * most if most == most else 0))
    return Chart("advise", frame, COLUMNS,
                 [Panel(x, y, panel) for y, panel in zip(axes, panels)], heading,
                 f"{kept} of {len(frame)} true errors are within their tolerance; {over}.",
                 [Filter("problem", "Scene")], is_side_by_side=True, size=(3.8, 3.6))
