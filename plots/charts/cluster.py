"""Simulated clusters: efficiency over the size of the plate and over the number of nodes."""
import pandas
from description import Axis, Chart, Filter, Look, Panel, Series, guide, keys_of, looks_of
from tables.results import NotMeasured

from .cells import HALO_LOOKS, OTHER_HALO

COLUMNS = {
    "label": "what varies", "set": "set", "elements": "elements", "ranks": "nodes",
    "network": "network", "decomposition": "decomposition", "halo": "halo",
    "simulated_own_node_efficiency": "efficiency (nodes as this core)",
    "simulated_paper_node_efficiency": "efficiency (the paper's node)",
    "simulated_own_node_communication_s": "time in exchanges (nodes as this core) [s]",
    "simulated_paper_node_communication_s": "time in exchanges (the paper's node) [s]",
    "simulated_own_node_wall_s": "time [s]", "status": "status"}
# `auto` often equals another strategy: its marks stand round those of the other one.
ROUND = {"is_hollow": True, "size": 14}
NODES = {"own": "nodes as this core", "paper": "the paper's node"}
GOOD = 0.95  # the efficiency of the dashed line


def rows_of(results):
    """Rows on several nodes, the slowest network first."""
    values = [f"simulated_{node}_node_{value}" for node in NODES
              for value in ("efficiency", "communication_s")]
    frame = results.table("cluster_simulated", "label", "set", "elements", "ranks", "network",
                          "status", optional=["halo", "decomposition", "latency_us",
                                              "bandwidth_mb_per_s", *values])
    frame = frame[(frame["ranks"] > 1) & (frame["status"] == "ok")]
    if frame["simulated_own_node_efficiency"].notna().sum() == 0:
        raise NotMeasured("tables/cluster_simulated.csv has no efficiency")
    return frame.sort_values("latency_us", ascending=False, kind="stable")


def cluster(results):
    """Efficiency and time in exchanges over the size of the plate.

    A network has panels, a halo strategy a line.
    """
    frame = rows_of(results)
    frame = frame[frame["label"] == "sizes"].copy()
    if frame.empty:
        raise NotMeasured('tables/cluster_simulated.csv has no block "sizes"')
    frame["n"] = pandas.to_numeric(frame["set"].astype(str).str.extract(r"n=(\d+)")[0])
    panels, titles, nodes = [], {}, int(frame["ranks"].max())
    x = Axis(f"elements a side, {nodes} nodes", "log")
    for node, words in NODES.items():
        efficiency, exchanges = (f"simulated_{node}_node_{value}"
                                 for value in ("efficiency", "communication_s"))
        above, below = [], []
        for (network, halo), rows in frame.groupby(["network", "halo"], sort=False):
            look = HALO_LOOKS.get(halo, OTHER_HALO).but(line="solid")
            look = look.but(**ROUND) if halo == "auto" else look
            keys, rows = keys_of(rows, "network", "halo"), rows.sort_values("n")
            above.append(Series(halo, rows, "n", efficiency, look, keys))
            if halo != "auto":  # it repeats one of the others
                below.append(Series(halo, rows[rows[exchanges] > 1e-6], "n", exchanges, look, keys))
            first = rows.iloc[0]
            titles[network,] = (f"{network}: {first['latency_us']:.3g} us, "
                                f"{first['bandwidth_mb_per_s']:.4g} MB/s")
        ends = [(frame["n"].min(), GOOD), (frame["n"].max(), GOOD)]
        above.append(guide("efficiency 0.95", ends, Look("soft", line="dash", width=1)))
        most = max(1.1, 1.05 * frame[efficiency].max())
        panels += [Panel(x, Axis(f"efficiency,\n{words}", limits=(0, most)), above),
                   Panel(x, Axis(f"in exchanges [s],\n{words}", "log"), below, 0.8)]
    heading = ("Simulated, not measured: parallel efficiency, and the time that a node spends in "
               "exchanges in 10,000 steps. A mark is a halo strategy. `auto` (large and hollow) is "
               "the best strategy that the simulation found.")
    return Chart("cluster_simulated", frame, COLUMNS, panels, heading, "",
                 [Filter("network", "Network", is_single=True), Filter("halo", "Halo")],
                 ("network",), titles=titles, size=(3.6, 2.6), height=380)


def by_nodes(results):
    """Efficiency over the number of nodes; each kind of variation has a panel."""
    frame = rows_of(results)
    frame = frame[(frame["label"] != "sizes") & frame["simulated_own_node_efficiency"].notna()]
    if frame.empty:
        raise NotMeasured("tables/cluster_simulated.csv has no other number of nodes")
    parts = ["network", "decomposition", "halo"]
    groups = list(frame.groupby(["label", *parts], sort=False, dropna=False))
    looks = {names: look.but(**ROUND) if names[-1] == "auto" else look for names, look in
             looks_of(list(dict.fromkeys(names[1:] for names, _ in groups)), line="solid").items()}
    series = [Series(", ".join(map(str, names[1:])), rows.sort_values("ranks"), "ranks",
                     "simulated_own_node_efficiency", looks[names[1:]],
                     keys_of(rows, "label", *parts)) for names, rows in groups]
    ticks = {count: str(count) for count in sorted(frame["ranks"].unique())}
    most = max(1.1, 1.05 * frame["simulated_own_node_efficiency"].max())
    panel = Panel(Axis("nodes", "log", ticks=ticks),
                  Axis("efficiency", limits=(0, most)), series)
    heading = ("Simulated, not measured: parallel efficiency on nodes as fast as one core of this "
               "machine. Weak scaling: each node has the same number of elements. Parts: one plate "
               "is cut in several ways. Hollow marks: `auto`, the best halo strategy found.")
    filters = [Filter("label", "What varies", is_single=True), Filter("network", "Network"),
               Filter("decomposition", "Decomposition"), Filter("halo", "Halo")]
    return Chart("cluster_simulated", frame, COLUMNS, [panel], heading, "", filters, ("label",),
                 size=(4.4, 3.4))
