"""The modelled balance between a slow and a fast executor, over the ratio of their speeds."""
from description import Axis, Chart, Filter, Look, Panel, Series, guide, keys_of, looks_of
from tables.results import NotMeasured

COLUMNS = {
    "n": "n", "speed_ratio": "speeds, fast over slow", "link": "bus", "overlapped": "overlapped",
    "latency_us": "latency [us]", "gb_per_s": "GB/s", "modelled_fast_share": "share of the fast",
    "modelled_of_sum": "speed over the sum of both",
    "modelled_of_fast": "speed over the fast one alone",
    "modelled_equal_split_of_fast": "two halves, speed over the fast one alone",
    "modelled_joining_pays": "the slow one helps", "status": "status"}


def balance(results):
    """Speed over the sum of both speeds, and over the fast one alone; each plate has a line."""
    frame = results.table("balance", "n", "speed_ratio", "link", "overlapped", "latency_us",
                          "gb_per_s", "slow_element_steps_per_s", "modelled_of_sum",
                          "modelled_of_fast", "modelled_equal_split_of_fast")
    if frame["modelled_of_sum"].isna().all():
        raise NotMeasured("no balance was modelled")
    frame["panel"] = frame["link"] + frame["overlapped"].map(
        lambda word: ", overlapped" if word == "yes" else ", not overlapped")
    frame["plate"] = frame["n"].map(lambda n: f"n = {n}")
    looks = looks_of([f"n = {n}" for n in sorted(frame["n"].unique())], line="solid", size=7)
    above, below, titles = [], [], {}
    for (name, plate), rows in frame.groupby(["panel", "plate"], sort=False):
        rows, keys = rows.sort_values("speed_ratio"), keys_of(rows, "panel", "plate")
        halves = Look(looks[plate].colour, line="dot", width=1)
        above.append(Series(plate, rows, "speed_ratio", "modelled_of_sum", looks[plate], keys))
        below.append(Series(plate, rows, "speed_ratio", "modelled_of_fast", looks[plate], keys))
        below.append(Series(f"two halves, {plate}", rows, "speed_ratio",
                            "modelled_equal_split_of_fast", halves, keys, entry=""))
        first = rows.iloc[0]
        titles[name,] = f"{name}\n{first['latency_us']:.3g} us, {first['gb_per_s']:.3g} GB/s"
    ratios = sorted(frame["speed_ratio"].unique())
    ends = [(ratios[0], 1), (ratios[-1], 1)]
    below.append(guide("the fast alone", ends, Look("soft", line="dash"), entry=""))
    slow, pays = frame["slow_element_steps_per_s"].iloc[0], (frame["modelled_of_fast"] > 1).sum()
    heading = (f"Modelled, not measured. The slow executor makes {1e-6 * slow:.3g} million "
               "element-steps/s. Solid lines: the best shares. Dotted lines: two halves. Above "
               "the dashed line the slow executor makes the fast one faster.")
    x = Axis("speeds, fast over slow", "log", ticks={ratio: f"{ratio:g}" for ratio in ratios})
    return Chart("balance", frame, COLUMNS, [
        Panel(x, Axis("speed over the sum of both", limits=(0, 1.05)), above),
        Panel(x, Axis("speed over the fast one alone", "log", ticks={
            ratio: f"{ratio:g}" for ratio in (0.01, 0.03, 0.1, 0.3, 1, 2)}), below)],
        heading, f"The slow executor helps in {pays} of {len(frame)} cases.",
        [Filter("panel", "Bus", is_single=True), Filter("plate", "Plate")], ("panel",),
        titles=titles, columns_of_facets=4, size=(3.2, 2.8))
