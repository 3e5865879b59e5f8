"""Efficiency on simulated clusters, over the size of the plate and the number of nodes."""
from ..results import NotMeasured
from .chart import OKABE_ITO, SYMBOLS, Chart, Filter, by_order, linear, logarithmic, points

COLUMNS = {"label": "what varies", "set": "set", "elements": "elements", "ranks": "nodes", "network": "network", "decomposition": "decomposition", "halo": "halo",
           "simulated_own_node_efficiency": "efficiency (nodes as this core)", "simulated_paper_node_efficiency": "efficiency (the paper's node)", "simulated_own_node_wall_s": "time [s]", "status": "status"}


def cluster(results):
    frame = results.table("cluster_simulated", "label", "elements", "ranks", "network", "halo", "decomposition", "simulated_own_node_efficiency", "status")
    frame = frame[frame["simulated_own_node_efficiency"].notna() & (frame["ranks"] > 1)]
    if frame.empty:
        raise NotMeasured("tables/cluster_simulated.csv has no efficiency")
    halos = ["auto"] if (frame["halo"] == "auto").any() else []
    colours, symbols = by_order(frame["network"].unique(), OKABE_ITO), by_order(frame["halo"].unique(), SYMBOLS)
    traces = []
    for (_, network, halo, decomposition), rows in frame.groupby(["label", "network", "halo", "decomposition"], sort=False):
        traces.append(points(rows.sort_values("elements"), "cluster_simulated", "elements", "simulated_own_node_efficiency", ["label", "network", "halo", "decomposition"], COLUMNS, mode="lines+markers",
                             name=f"{network}, {halo}", legendgroup=f"{network}, {halo}", line={"color": colours[network], "width": 1.3}, marker={"size": 9, "symbol": symbols[halo]}))
    text = ("Simulated, not measured: parallel efficiency on nodes as fast as one core of this machine, by the size of the plate. A colour is a network, a mark a halo strategy. "
            f"{'The strategy auto is the best that the simulation found.' if halos else ''}")
    layout = {"xaxis": logarithmic("elements"), "yaxis": linear("efficiency", rangemode="tozero")}
    return Chart(text, "cluster_simulated", traces, layout, frame, COLUMNS, [Filter("label", "What varies", is_single=True), Filter("halo", "Halo"), Filter("network", "Network"),
                                                                           Filter("decomposition", "Decomposition")])
