"""The stability limits of methods, and the energy of an undamped mode in a stable step."""
import pandas
from description import (Axis, Chart, ColourScale, Filter, Look, Panel, Series, guide, keys_of,
                         looks_of)
from tables.results import NotMeasured
from tables.words import problem

COLUMNS = {
    "integrator": "method", "problem": "scene", "zeta": "damping ratio",
    "predicted_dt_s": "predicted step [s]", "measured_dt_s": "measured step [s]",
    "ratio": "measured / predicted", "measured_h_omega": "measured h omega",
    "predicted_h_omega": "predicted h omega", "status": "status", "reason": "reason",
    "prediction": "prediction"}
NO_DAMPING = 1e-3  # where zeta = 0 is drawn on a logarithmic axis
STEP = "step times frequency, h omega [rad]"
# From blue (every motion shrinks) over white (no change) to red (some motion grows). Any colour
# vision can tell these apart.
RADIUS = ColourScale("spectral radius of one step", 0, 1.5, (
    (0, "#2166AC"), (0.35, "#92C5DE"), (0.6533, "#F7F7F7"), (0.6668, "#F7F7F7"),
    (0.69, "#F4A582"), (1, "#B2182B")))
KINDS = {"one mode": Look("#000000", "circle", size=8),
         "a scene": Look("#000000", "diamond", is_hollow=True, size=8)}


def map_of(rows):
    """The theory of one method: its spectral radius and the line of its limit."""
    keys = keys_of(rows, "integrator")
    yield Series("theory", rows, "h_omega", "zeta", Look(), keys, entry="", kind="field",
                 z="spectral_radius", scale=RADIUS)
    limits = rows.groupby("zeta")["limit_h_omega"].first()
    yield guide("limit in theory", list(zip(limits, limits.index)),
                Look("#000000", line="solid", width=2), keys=keys)


def stability(results):
    """A map of each method with its measured limits."""
    limits = results.table("stability", "scene", "integrator", "zeta", "status", optional=[
        "set", "predicted_h_omega", "measured_h_omega", "ratio", "prediction"])
    theory = results.table("stability_map", "integrator", "zeta", "h_omega", "spectral_radius",
                           optional=["limit_h_omega"])
    limits["problem"] = [problem(row["scene"], row["set"]) for _, row in limits.iterrows()]
    measured = limits[limits["measured_h_omega"] > 0]
    if measured.empty:
        raise NotMeasured("no limit was measured")
    is_mode = measured["scene"] == "one_mode"
    measured = measured.assign(shown_zeta=measured["zeta"].clip(lower=NO_DAMPING),
                               kind=is_mode.map({True: "one mode", False: "a scene"}))
    series = [one for _, rows in theory.groupby("integrator", sort=False) for one in map_of(rows)]
    for (_, kind, _), rows in measured.groupby(["integrator", "kind", "status"], sort=False):
        series.append(Series(f"measured: {kind}", rows, "measured_h_omega", "shown_zeta",
                             KINDS[kind], keys_of(rows, "integrator", "status")))
    is_exact = limits["prediction"].astype(str).str.startswith("exact")
    ratios = measured.loc[(measured["status"] == "ok") & is_exact, "ratio"].dropna()
    farthest = 100 * (ratios - 1).abs().max()
    words = (f"{len(ratios)} limits have an exact prediction; the largest difference to it is "
             f"{farthest:.2g} %. " if len(ratios) else "")
    heading = ("Blue: a step shrinks every motion. Red: some motion grows. The line is the limit "
               "in theory, the marks are measured limits. Undamped ones are at the lower edge.")
    findings = (f"{words}The {len(theory)} points of theory are in tables/stability_map.csv, the "
                "measured limits in the table below.")
    x, y = theory["h_omega"], theory["zeta"]
    ticks = {tick: f"{tick:g}" for tick in (0.01, 0.1, 1, 10)}
    panel = Panel(Axis(STEP, "log", limits=(0.9 * x.min(), None)),
                  Axis("damping ratio zeta", "log", limits=(NO_DAMPING / 1.15, y.max()),
                       ticks={NO_DAMPING: "0", **ticks}), series)
    return Chart("stability", limits, COLUMNS, [panel], heading, findings,
                 [Filter("integrator", "Method", is_single=True), Filter("status", "Status")],
                 ("integrator",), height=520, size=(3.4, 3))


ENERGY_COLUMNS = {
    "integrator": "method", "h_omega": "h omega", "theory_energy_change_per_step": "theory",
    "measured_energy_change_per_step": "measured", "steps": "steps"}


def energy(results):
    """The change of energy in a step, with its sign, and below its size on a logarithmic axis."""
    theory, seen = "theory_energy_change_per_step", "measured_energy_change_per_step"
    frame = results.table("stability_energy", "integrator", "h_omega", theory, seen)
    frame = frame.sort_values(["integrator", "h_omega"], kind="stable")
    if frame[seen].isna().all():
        raise NotMeasured("tables/stability_energy.csv has no change of energy that was measured")
    looks, signed, sizes, drawn = looks_of(frame["integrator"].unique(), size=7), [], [], []
    for method, rows in frame.groupby("integrator", sort=False):
        keys, look = keys_of(rows, "integrator"), looks[method]
        drawn.append(tuple(rows[theory].round(9)))
        alike = drawn.count(drawn[-1]) - 1
        if alike:  # methods with the same theory: one mark stands round the other
            look = look.but(is_hollow=True, size=7 + 5 * alike)
        line = look.but(mark="", line="solid")
        # Where theory has no change, only rounding is measured.
        changing = rows[rows[theory] != 0].copy()
        changing["size"] = changing[seen].abs()
        shown = pandas.DataFrame({"x": rows["h_omega"], "y": rows[theory]})
        named = {"keys": keys, "entry": method}
        signed += [Series(method, rows, "h_omega", seen, look, keys),
                   guide(f"{method}, theory", shown.to_numpy(), line, **named)]
        shown = shown[shown["y"] != 0].abs()
        sizes += [Series(method, changing, "h_omega", "size", look, keys),
                  guide(f"{method}, theory", shown.to_numpy(), line, **named)]
    worst = frame.loc[frame[seen].idxmin()]
    heading = ("Change of energy in one step of an undamped mode. Lines are theory, marks are "
               "runs. Stable is not accurate: the largest loss of a stable step is "
               f"{-100 * worst[seen]:.0f} %, of {worst['integrator']} at h omega = "
               f"{worst['h_omega']:.3g}.")
    x = Axis(STEP)
    return Chart("stability_energy", frame, ENERGY_COLUMNS, [
        Panel(x, Axis("change of energy in a step", is_percent=True, limits=(-1.05, 0.6)), signed),
        Panel(x, Axis("size of the change, relative", "log", limits=(1e-12, 10)), sizes)],
        heading, "", [Filter("integrator", "Method")], size=(7.5, 3.6))
