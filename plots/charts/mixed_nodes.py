"""Simulated clusters of nodes of several speeds, with equal parts and with parts by speed."""
from description import Axis, Chart, Filter, Look, Panel, Series, guide, keys_of, looks_of
from tables.results import NotMeasured
from tables.words import problem

COLUMNS = {
    "problem": "scene", "nodes": "nodes", "network": "network", "halo": "exchange",
    "shares": "parts", "imbalance": "slowest part over balance",
    "simulated_wall_s": "time [s]", "ideal_wall_s": "ideal time [s]", "efficiency": "efficiency",
    "fastest_alone_wall_s": "the fastest nodes alone [s]",
    "over_fastest_alone": "speed over the fastest nodes alone",
    "over_equal": "speed over equal parts", "status": "status"}


def mixed_nodes(results):
    """Speed over the fastest nodes alone, and efficiency, by mix of nodes."""
    frame = results.table("mixed_nodes", "scene", "set", "label", "nodes", "network", "halo",
                          "shares", "over_fastest_alone", "efficiency", "over_equal",
                          optional=["imbalance"])
    if frame["over_fastest_alone"].isna().all():
        raise NotMeasured("no cluster of mixed nodes was simulated")
    frame["problem"] = [problem(row["scene"], row["set"]) for _, row in frame.iterrows()]
    mixes = list(dict.fromkeys(frame["nodes"]))
    looks, over, efficiency = looks_of(frame["shares"].unique(), line="", size=9), [], []
    for names, rows in frame.groupby(["shares", "problem", "network", "halo"], sort=False):
        keys = keys_of(rows, "shares", "problem", "network", "halo")
        look = looks[names[0]]
        over.append(Series(names[0], rows, "nodes", "over_fastest_alone", look, keys))
        efficiency.append(Series(names[0], rows, "nodes", "efficiency", look, keys))
    over.append(guide("the fastest nodes alone", [(mix, 1) for mix in mixes],
                      Look("soft", line="dash")))
    by_speed = frame[frame["shares"] == "by speed"]
    equal = frame[frame["shares"] == "equal"]
    words = (f"With parts by speed, clusters reach {by_speed['efficiency'].min():.2f} to "
             f"{by_speed['efficiency'].max():.2f} of the sum of their speeds, and the slower nodes "
             f"help in {(by_speed['over_fastest_alone'] > 1).sum()} of {len(by_speed)} cases. With "
             f"equal parts they help in {(equal['over_fastest_alone'] > 1).sum()} of {len(equal)}.")
    heading = ("Simulated, with the published speeds of the paper's nodes. Above the dashed line "
               "the slower nodes make the fastest ones faster.")
    x = Axis("", "category", categories=mixes)
    return Chart("mixed_nodes", frame, COLUMNS, [
        Panel(x, Axis("speed over the fastest nodes alone", limits=(0, None)), over),
        Panel(x, Axis("efficiency", limits=(0, 1.05)), efficiency)], heading, words, [
            Filter("problem", "Scene"), Filter("network", "Network"), Filter("halo", "Exchange"),
            Filter("shares", "Parts")], size=(7, 2.8))
