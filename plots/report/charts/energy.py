"""What a stable step does to the energy of an undamped mode."""
from ..results import NotMeasured
from .chart import OKABE_ITO, SYMBOLS, Chart, Filter, by_order, linear, plain, points

COLUMNS = {"integrator": "method", "h_omega": "h omega", "theory_energy_change_per_step": "theory", "measured_energy_change_per_step": "measured", "steps": "steps"}


def energy(results):
    frame = results.table("stability_energy", "integrator", "h_omega", "theory_energy_change_per_step", "measured_energy_change_per_step").sort_values(["integrator", "h_omega"], kind="stable")
    colours, symbols, traces = by_order(frame["integrator"].unique(), OKABE_ITO), by_order(frame["integrator"].unique(), SYMBOLS), []
    for method, rows in frame.groupby("integrator", sort=False):
        traces.append(points(rows, "stability_energy", "h_omega", "measured_energy_change_per_step", ["integrator"], COLUMNS, mode="markers", name=method, legendgroup=method,
                             marker={"color": colours[method], "symbol": symbols[method], "size": 7}))
        traces.append({"type": "scatter", "mode": "lines", "x": plain(rows["h_omega"]), "y": plain(rows["theory_energy_change_per_step"]), "line": {"color": colours[method], "width": 1.3},
                       "name": method, "legendgroup": method, "meta": {"integrator": method}, "hoverinfo": "skip"})
    if frame["measured_energy_change_per_step"].isna().all():
        raise NotMeasured("tables/stability_energy.csv has no change of energy that was measured")
    worst = frame.loc[frame["measured_energy_change_per_step"].idxmin()]
    text = (f"Change of energy in one step, below the stability limit: lines are theory, marks are runs. Most is lost by {worst['integrator']} at h omega = {worst['h_omega']:.3g}: "
            f"{100 * worst['measured_energy_change_per_step']:.0f} % in a step, and stable.")
    layout = {"xaxis": linear("step times frequency, h omega [rad]"), "yaxis": linear("change of energy in a step", tickformat=".0%", range=[-1.05, 0.6])}
    return Chart(text, "stability_energy", traces, layout, frame, COLUMNS, [Filter("integrator", "Method")])
