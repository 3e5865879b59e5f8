"""Charts of tables of cells, such as Tables 1 to 3: speed-ups, scaling and the paper's figure 9."""
import re

import pandas
from description import (Axis, Chart, Filter, Look, Panel, Series, by_order, colours_of, guide,
                         keys_of, looks_of)
from tables.results import NotMeasured, is_pair
from tables.words import is_missing, shown

VARIANT_COLOURS = {"reference": "#999999", "scalar": "#E69F00", "scalar-native": "#56B4E9",
                   "avx2": "#009E73", "avx512": "#0072B2"}
HALO_LOOKS = {"sendrecv": Look("#D55E00", "square"), "overlap": Look("#E69F00", "triangle-up"),
              "deep": Look("#0072B2", "circle"), "deep-overlap": Look("#56B4E9", "diamond"),
              "shared": Look("#009E73", "triangle-down"), "auto": Look("#CC79A7", "cross")}
OTHER_HALO = Look("#999999", "x")
CELL = ["source", "label", "variant", "threads", "status"]
PROBLEM = ["scene", "set", "model", "precision", "integrator"]
# The points of one line have equal values in these columns.
LINE = ["scene", "variant", "threads", "model", "precision", "integrator"]
INTERVALS = ["speedup_vs_1_rank", "weak_efficiency"]
STEPS = 10000  # in the paper's figure 9


def ends_of(column):
    """The columns of the interval of a column."""
    return f"{column}_low", f"{column}_high"


def base_of(frame, table):
    """The variant that speed-ups refer to: the last one with a column of speed-ups."""
    columns = [re.fullmatch(r"(?:extrapolated_)?speedup_vs_(.*)", name) for name in frame.columns]
    found = [match[1] for match in columns if match and match[1] in set(frame["variant"])]
    if not found:
        raise NotMeasured(f"tables/{table}.csv has no speed-up")
    return found[-1]


def with_speedup(frame, base):
    """Measured rows with a speed-up, which may be scaled from fewer steps."""
    rows = frame[frame["source"] == "measured"].copy()
    exact = rows.get(f"speedup_vs_{base}", pandas.Series(float("nan"), rows.index))
    rows["is_scaled"] = exact.isna()
    for end in ("", "_low", "_high"):
        names = f"speedup_vs_{base}{end}", f"extrapolated_speedup_vs_{base}{end}"
        exact, scaled = (rows.get(name, pandas.Series(float("nan"), rows.index)) for name in names)
        rows[f"speedup{end}"] = exact.where(~rows["is_scaled"], scaled)
    rows["is_doubtful"] = 2 * rows["contaminated"].fillna(0) >= rows["repetitions"]
    rows["value"] = [f"{value:.3g}{'  (contaminated)' * bool(doubtful)}"
                     for value, doubtful in zip(rows["speedup"], rows["is_doubtful"])]
    return rows[rows["speedup"].notna()].copy()


def base_time(rows, base):
    """The base and its time in words."""
    own = rows[(rows["variant"] == base) & (rows["threads"] == 1) & ~is_pair(rows)
               & (rows["ranks"].fillna(1) == 1)]
    if own.empty or is_missing(own.iloc[0]["measured_wall_s"]):
        return f"base {base}"
    row = own.iloc[0]
    return f"base: {base}, 1 thread, {row['measured_wall_s']:.3g} s for {int(row['steps'])} steps"


def speedups(table):
    """The speed-ups of a table: each problem has a panel, each cell a bar."""
    def make(results):
        frame = results.table(table, *CELL, "scene", "repetitions", optional=[
            *PROBLEM, "ranks", "contaminated", "measured_wall_s", "steps", "resolution"])
        base = base_of(frame, table)
        rows = with_speedup(frame, base)
        if rows.empty:
            raise NotMeasured(f"no cell of tables/{table}.csv has a speed-up against {base}")
        rows["problem"] = [" ".join(str(row[name]) for name in PROBLEM if shown(row[name]))
                           for _, row in rows.iterrows()]
        colours, series = colours_of(rows["variant"].unique(), VARIANT_COLOURS), []
        for (problem, variant, is_scaled), own in rows.groupby(
                ["problem", "variant", "is_scaled"], sort=False):
            name = f"{variant}, scaled from fewer steps" if is_scaled else variant
            series.append(Series(name, own, "speedup", "label",
                                 Look(colours[variant], hatch="/" if is_scaled else ""),
                                 keys_of(own, "problem"), kind="bars", low="speedup_low",
                                 high="speedup_high", interval_of="x", label="value"))
        for problem, own in rows.groupby("problem", sort=False):
            ends = [(1, own["label"].iloc[place]) for place in (0, -1)]
            series.append(guide("base", ends, Look(line="dot", width=1), entry="",
                                keys={"problem": problem}))
        has_intervals = rows["speedup_low"].notna().any()
        heading = (f"Speed-up against {base}, 1 thread: medians of paired ratios, "
                   f"{'95 % intervals' if has_intervals else 'too few repetitions for intervals'}")
        resolution = rows["resolution"].dropna()
        if len(resolution):
            heading += f"; resolution {100 * resolution.iloc[0]:.1f} %"
        best = rows.loc[rows["speedup"].idxmax()]
        columns = {"label": "cell", "problem": "problem", "speedup": f"against {base}",
                   "speedup_low": "from", "speedup_high": "to", "steps": "steps",
                   "measured_wall_s": "median time [s]", "repetitions": "repetitions",
                   "contaminated": "contaminated", "status": "status"}
        titles = {(problem,): f"{problem} ({base_time(own, base)})"
                  for problem, own in rows.groupby("problem", sort=False)}
        labels = list(dict.fromkeys(rows["label"]))
        longest = max(rows.groupby("problem", sort=False)["label"].nunique())
        most = rows[["speedup", "speedup_high"]].max().max()  # and room for the labels
        panel = Panel(Axis(f"speed-up against {base}", limits=(0, 1.2 * most)),
                      Axis(scale="category", categories=labels, is_reversed=True), series)
        return Chart(table, rows, columns, [panel], f"{heading}.",
                     f"The largest is {best['speedup']:.3g}: {best['label']}, {best['problem']}.",
                     [Filter("problem", "Problem", is_single=True)], ("problem",), titles=titles,
                     height=200 + 24 * longest, size=(7.5, 0.9 + 0.27 * longest),
                     columns_of_facets=1)
    return make


def with_points(rows, base, measured, scale):
    """Rows with their ratio to one rank.

    Where workers share cores, it is a ratio of rates; elsewhere a measured speed-up.
    """
    rows = rows[rows["ranks"] > 1].sort_values("ranks").copy()
    ratio = scale(rows) * rows["element_steps_per_s"] / base["element_steps_per_s"]
    rows["is_hollow"] = rows["status"] == "oversubscribed"
    rows["point"] = rows[measured].where(~rows["is_hollow"], ratio)
    for name, column in zip(("point_low", "point_high"), ends_of(measured)):
        rows[name] = rows[column]
    return rows[rows["point"].notna()]


def problems_over_ranks(frame):
    """(values of LINE, words, rows, base) of each problem that ran on one rank and on several."""
    def named(names):
        return dict(zip(LINE, names))
    for names, group in frame.groupby([*LINE, "set"], sort=False, dropna=False):
        base = group[group["ranks"] == 1]
        if not base.empty:
            rows = with_points(group, base.iloc[0], "speedup_vs_1_rank", lambda cells: 1)
            yield named(names), f"{names[0]} {shown(names[-1])}", rows, base
    weak = frame[frame["weak_base_set"].notna()]
    for names, group in weak.groupby([*LINE, "weak_base_set"], sort=False):
        own = (frame[LINE] == pandas.Series(named(names))).all(axis=1)
        base = frame[own & (frame["ranks"] == 1) & (frame["set"] == names[-1])]
        if not base.empty:
            rows = with_points(group, base.iloc[0], "weak_efficiency",
                               lambda cells: 1 / cells["ranks"])
            yield named(names), f"weak scaling, {names[0]} from {names[-1]}", rows, base


def panels_over_ranks(frame):
    """(name, title, rows, base) of each panel; the one with the most strategies is the first."""
    found = []
    for line, words, rows, base in problems_over_ranks(frame):
        if rows.empty:
            continue
        threads = f"{int(line['threads'])} thread{'s' * bool(line['threads'] > 1)} a rank"
        name = f"{line['variant']}, weak" if words.startswith("weak") else line["variant"]
        title = f"{line['variant']}, {words.strip()}, {threads}"
        found.append((name, title, rows, base.iloc[:1]))
    names = [name for name, *_ in found]
    found = [(title if names.count(name) > 1 else name, title, *of) for name, title, *of in found]
    return sorted(found, key=lambda panel: -panel[2]["halo"].nunique())


def halo_series(panel, rows, base):
    """(series of ratios, series of shares) of each halo strategy, side by side at each rank."""
    groups = list(rows.groupby(["halo", "decomposition"], sort=False, dropna=False))
    for place, ((halo, decomposition), line) in enumerate(groups):
        words = [shown(halo), shown(decomposition)]
        name = words[0] if words[1] in ("strips", "") else ", ".join(words)
        start = base.assign(point=1.0, is_hollow=False, point_low=None, point_high=None)
        line = pandas.concat([start, line]).assign(variant=panel, halo=halo)
        shift = 0.07 * (place - (len(groups) - 1) / 2)
        line["place"] = line["ranks"] + shift * (line["ranks"] > 1)
        look = HALO_LOOKS.get(halo, OTHER_HALO).but(line="solid", width=1, size=9)
        ratio = Series(name, line, "place", "point", look, keys_of(line, "variant", "halo"),
                       low="point_low", high="point_high", hollow="is_hollow")
        yield ratio, Series(name, line[line["ranks"] > 1], "place", "communication_share", look,
                            ratio.keys, hollow="is_hollow")


RANKS_COLUMNS = {
    "label": "cell", "set": "set", "ranks": "ranks", "halo": "halo", "halo_used": "halo that ran",
    "measured_wall_s": "median time [s]", "point": "against 1 rank", "point_low": "from",
    "point_high": "to", "parallel_efficiency": "efficiency",
    "communication_share": "share of time in exchanges", "status": "status"}


def scaling(table):
    """The ratios to one rank over the number of ranks, and the time in exchanges below."""
    def make(results):
        optional = [*PROBLEM, "ranks", "halo", "decomposition", "weak_base_set", *INTERVALS,
                    *(end for column in INTERVALS for end in ends_of(column)),
                    "communication_share", "element_steps_per_s"]
        frame = results.table(table, *CELL, "cores", optional=optional)
        frame = frame[(frame["source"] == "measured") & frame["element_steps_per_s"].notna()
                      & ~is_pair(frame) & frame["status"].isin(["ok", "oversubscribed"])]
        panels = panels_over_ranks(frame)
        if not panels:
            raise NotMeasured("no cell on several ranks has a cell on one rank to compare with")
        ratios, shares, titles = [], [], {}
        for name, title, rows, base in panels:
            titles[name,] = title
            for ratio, share in halo_series(name, rows, base):
                ratios.append(ratio)
                shares.append(share)
            most = int(rows["ranks"].max())
            ideal = [(1, 1), (most, 1 if "weak" in title else most)]
            ratios.append(guide("ideal", ideal, Look("soft", line="dot"), keys={"variant": name}))
        rows = pandas.concat([panel[2].assign(variant=panel[0]) for panel in panels])
        bases = [base.assign(variant=name, point=1.0) for name, _, _, base in panels]
        cores, best = int(rows["cores"].max()), rows[~rows["is_hollow"]]
        findings = "" if best.empty else (f"The largest speed-up is {best['point'].max():.3g} "
                                          f"({best.loc[best['point'].idxmax(), 'label']}).")
        heading = ("The speed over that of one rank of the same variant (weak scaling: the speed "
                   "of each rank). Medians of paired ratios with 95 % intervals. Hollow marks: "
                   f"more workers than the {cores} cores; they are ratios of rates, no speed-ups.")
        ticks = {rank: f"{rank}" for rank in [1, *sorted(rows["ranks"].astype(int).unique())]}
        x = Axis("ranks", ticks=ticks, limits=(0.7, rows["ranks"].max() + 0.4))
        top = rows[["point", "point_high"]].max().max()
        return Chart(table, pandas.concat([*bases, rows]), RANKS_COLUMNS, [
            Panel(x, Axis("speed against 1 rank", limits=(0, max(1.15 * top, 1.15))), ratios),
            Panel(x, Axis("time in exchanges", is_percent=True, limits=(0, 1.05)), shares,
                  height=0.5)],
            heading, findings, [Filter("variant", "Variant", is_single=True),
                                Filter("halo", "Halo strategy")],
            ("variant",), titles=titles, size=(3.9, 3.6))
    return make


def fastest_of(timed, paper, most=8):
    """The published configurations, and the fastest ones here on the largest plate."""
    published = list(paper["label"].unique())
    largest = timed[timed["n"] == timed["n"].max()].sort_values("time_s")
    return published + list(largest["label"].unique())[:max(0, most - len(published))]


def figure9(table):
    """The time of 10,000 steps over the side of the plate, measured here and published."""
    def make(results):
        frame = results.table(table, "source", "label", "set", "status", "measured_wall_s",
                              "paper_wall_s", "steps", optional=["precision", "reason"])
        frame = frame[~is_pair(frame)].copy()
        frame["n"] = pandas.to_numeric(frame["set"].astype(str).str.extract(r"\bn=(\d+)")[0])
        frame = frame[frame["n"].notna()].sort_values("n", kind="stable")
        measured, paper = (frame[frame["source"] == name] for name in ("measured", "paper"))
        if paper.empty or measured["n"].nunique() < 2:
            raise NotMeasured("there are no published times beside measured ones")
        timed = measured[measured["measured_wall_s"].notna() & (measured["status"] == "ok")]
        timed = timed.assign(time_s=timed["measured_wall_s"] / timed["steps"] * STEPS)
        paper = paper.assign(time_s=paper["paper_wall_s"])
        has_several = timed["precision"].nunique() > 1
        groups = list(timed.groupby(["label", "precision"], sort=False, dropna=False))
        looks, series = looks_of([names for names, _ in groups], line="solid"), []
        for names, rows in groups:
            name = ", ".join(names) if has_several else names[0]
            series.append(Series(name, rows, "n", "time_s", looks[names],
                                 keys_of(rows, "source", "label")))
        marks = by_order(paper["label"].unique(), ["circle", "square", "diamond", "triangle-up"])
        for label, rows in paper.groupby("label", sort=False):
            look = Look("soft", marks[label], "dash", is_hollow=True)
            series.append(Series(f"{label} (paper)", rows, "n", "time_s", look,
                                 keys_of(rows, "source", "label")))
        lacking = measured[measured["status"] == "unavailable"]
        names = "; ".join(dict.fromkeys(lacking["label"]))
        findings = (f"Unavailable here: {names} ({shown(lacking['reason'].iloc[0])})."
                    if names else "")
        heading = ("Filled marks: measured here, and scaled to 10,000 steps if fewer ran. Hollow "
                   "marks: published, on the paper's machines.")
        columns = {"label": "configuration", "source": "source", "set": "plate",
                   "time_s": f"time of {STEPS:,} steps [s]", "steps": "steps that ran",
                   "status": "status"}
        ticks = {n: f"{n}" for n in sorted(frame["n"].astype(int).unique())}
        panel = Panel(Axis("elements a side, n", "log", ticks=ticks),
                      Axis(f"time of {STEPS:,} steps [s]", "log"), series)
        return Chart(table, pandas.concat([timed, paper]), columns, [panel],
                     f"{heading} {findings}".strip(), "",
                     [Filter("source", "Source"), Filter("label", "Configuration", opens_with=(
                         "published, and the fastest here", fastest_of(timed, paper)))],
                     size=(7, 5), height=540)
    return make
