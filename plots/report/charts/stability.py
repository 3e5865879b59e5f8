"""The spectral radius of a step over step and damping, with measured limits."""
import math

from stability_map import NO_DAMPING

from ..results import NotMeasured
from ..words import problem
from .chart import Chart, Filter, logarithmic, plain, points

COLUMNS = {"integrator": "method", "problem": "scene", "zeta": "damping ratio", "predicted_dt_s": "predicted step [s]", "measured_dt_s": "measured step [s]", "ratio": "measured / predicted",
           "measured_h_omega": "measured h omega", "predicted_h_omega": "predicted h omega", "status": "status", "reason": "reason", "prediction": "prediction"}
# From blue (the step shrinks every motion) by the ground of the page (neither) to red (some motion grows): RdBu, safe with any colour vision.
SHADES = [[0, "#2166AC"], [0.35, "#92C5DE"], [0.6533, "#F7F7F7"], [0.6668, "#F7F7F7"], [0.69, "#F4A582"], [1, "#B2182B"]]
HIGHEST = 1.5


def map_of(method, rows):
    """Theory of one method: shades, and the line of its limit."""
    grid = rows.pivot(index="zeta", columns="h_omega", values="spectral_radius")
    yield {"type": "heatmap", "x": plain(grid.columns), "y": plain(grid.index), "z": [plain(line, 4) for line in grid.to_numpy().clip(max=HIGHEST).tolist()], "zmin": 0, "zmax": HIGHEST,
           "colorscale": SHADES, "colorbar": {"title": {"text": "spectral radius", "side": "right"}, "thickness": 12}, "meta": {"integrator": method}, "name": "theory",
           "hovertemplate": "h omega %{x:.3g}, damping ratio %{y:.3g}: spectral radius %{z:.4g}<extra>theory</extra>"}
    limits = rows.groupby("zeta")["limit_h_omega"].first()
    yield {"type": "scatter", "mode": "lines", "x": plain(limits), "y": plain(limits.index), "name": "limit in theory", "legendgroup": "theory", "line": {"color": "#000000", "width": 2},
           "meta": {"integrator": method}, "hoverinfo": "skip"}


def edges(values):
    """The range of a logarithmic axis, with room for marks at its ends."""
    return [math.log10(values.min()) - 0.06, math.log10(values.max()) + 0.02]


def stability(results):
    limits = results.table("stability", "scene", "set", "integrator", "zeta", "predicted_h_omega", "measured_h_omega", "ratio", "prediction", "status")
    theory = results.table("stability_map", "integrator", "zeta", "h_omega", "spectral_radius", "limit_h_omega")
    limits["problem"] = [problem(row["scene"], row["set"]) for _, row in limits.iterrows()]
    measured = limits[limits["measured_h_omega"] > 0]
    if measured.empty:
        raise NotMeasured("no limit was measured")
    measured = measured.assign(shown_zeta=measured["zeta"].clip(lower=NO_DAMPING), kind=measured["scene"].map(lambda scene: "one mode" if scene == "one_mode" else "a scene"))
    traces = [trace for method, rows in theory.groupby("integrator", sort=False) for trace in map_of(method, rows)]
    for (_, kind, _), rows in measured.groupby(["integrator", "kind", "status"], sort=False):
        traces.append(points(rows, "stability", "measured_h_omega", "shown_zeta", ["integrator", "status"], COLUMNS, mode="markers", name=f"measured: {kind}", legendgroup=kind,
                             marker={"size": 10, "symbol": "circle" if kind == "one mode" else "diamond", "color": "#000000" if kind == "one mode" else "#FFFFFF", "line": {"width": 1.5, "color": "#000000"}}))
    ratios = measured.loc[(measured["status"] == "ok") & measured["prediction"].astype(str).str.startswith("exact"), "ratio"].dropna()
    words = f" Of {len(ratios)} limits with an exact prediction the farthest is off by {100 * (ratios - 1).abs().max():.2g} %." if len(ratios) else ""
    text = (f"Blue: a step shrinks every motion; red: some motion grows; the line is the limit in theory, the marks are limits as runs show them (undamped ones at the lower edge).{words} "
            f"The map has {len(theory)} points of theory, which are in tables/stability_map.csv; the table below has the limits.")
    layout = {"xaxis": logarithmic("step times frequency, h omega [rad]", range=edges(theory["h_omega"])), "yaxis": logarithmic("damping ratio zeta", range=edges(theory["zeta"]))}
    return Chart(text, "stability", traces, layout, limits, COLUMNS, [Filter("integrator", "Method", is_single=True), Filter("status", "Status")], height=520)
