"""Tables 1 to 3 of the paper: what is published, what is measured here and what is simulated, in columns of their own."""
import dataclasses

import pandas

from tables.results import NotMeasured
from tables.words import is_missing, shown, with_interval

NETWORKS = {"gigabit": "1 GbE", "ten_gigabit": "10 GbE", "fdr": "FDR"}


@dataclasses.dataclass
class Cell:
    """A text, and the row that it is from: a path from the directory of results, without .csv, and a line."""
    text: str
    table: str = ""
    line: int = 0


@dataclasses.dataclass
class Grid:
    """A table whose columns stand in groups: groups are (kind, heading, columns); a kind is "", paper, measured, scaled or simulated."""
    name: str
    title: str
    tables: list
    groups: list
    rows: list
    notes: list
    filters: dict = dataclasses.field(default_factory=dict)  # label: a value for each row


def measured_rows(results, table, *needed):
    frame = results.table(table, "source", "label", "set", "measured_wall_s", "steps", "status", *needed)
    return frame[frame["source"] == "measured"]


def paper_rows(results, table):
    frame = results.table(table, "source", "label", "paper_wall_s", "paper_speedup")
    frame = frame[frame["source"] == "paper"].copy()
    frame["processes"] = frame["label"].str.extract(r"^(\d+) process", expand=False).astype(float)
    frame["is_base"] = frame["label"].str.contains("no vectorisation", regex=False)
    return frame


def first(frame):
    """The first row, or none."""
    return None if frame.empty else frame.iloc[0]


def reference(row, table):
    return Cell("") if row is None else Cell(f"{table.removeprefix('tables/')}.csv:{row['line']}", table, int(row["line"]))


def wall(row):
    return "" if row is None else with_interval(row["measured_wall_s"], row.get("measured_wall_low_s"), row.get("measured_wall_high_s"))


def speedup(row, base, before=""):
    """Against `base`, with its interval; `before` is extrapolated_ for one that is scaled from fewer steps. Empty where more workers than cores make it no speed-up."""
    column = f"{before}speedup_vs_{base}"
    return "" if row is None else with_interval(row.get(column), row.get(f"{column}_low"), row.get(f"{column}_high"))


def simulated_rows(results, table, parameter_label):
    """Of the paper's own cluster and exchange."""
    try:
        frame = results.table(f"{table}_simulated", "label", "ranks", "network", "halo", "simulated_paper_node_wall_s")
    except NotMeasured:
        return None
    return frame[frame["label"].str.startswith(parameter_label, na=False) & (frame["halo"] == "sendrecv")]


def table_of_processes(results, name, table, title, variant):
    """Table 1 or 2: processes down, published, measured and simulated times across."""
    measured, paper = measured_rows(results, table, "ranks", "threads", "halo", "variant"), paper_rows(results, table)
    if paper.empty and measured.empty:
        raise NotMeasured(f"tables/{table}.csv has no rows")
    simulated = simulated_rows(results, table, "the paper's cluster")
    own = measured[(measured["variant"] == variant) & (measured["threads"] == 1) & ~measured["label"].str.contains("A/A", regex=False)]
    own = own[own["set"] == own["set"].iloc[0]] if not own.empty else own  # strong scaling; weak has other sizes
    rows = []
    for _, published in paper.iterrows():
        if published["is_base"]:
            here = first(measured[(measured["variant"] == "scalar") & (measured["threads"] == 1)])
        else:
            at = own[own["ranks"] == published["processes"]]
            here = first(at[at["halo"] == "auto"]) if (at["halo"] == "auto").any() else first(at)
        cells = [Cell(published["label"]), Cell(shown(published["paper_wall_s"], 6)), Cell(shown(published["paper_speedup"], 4)), reference(published, f"tables/{table}")]
        cells += [Cell("" if here is None else here["label"]), Cell(wall(here)), Cell(speedup(here, "scalar")), Cell("" if here is None else str(here["status"])), reference(here, f"tables/{table}")]
        alike = None if simulated is None or published["is_base"] else simulated[simulated["ranks"] == published["processes"]]
        of_networks = [None if alike is None else first(alike[alike["network"] == network]) for network in NETWORKS]
        cells += [Cell("" if row is None else shown(row["simulated_paper_node_wall_s"], 4)) for row in of_networks]
        lines = [int(row["line"]) for row in of_networks if row is not None]
        cells.append(Cell(f"{table}_simulated.csv:{', '.join(map(str, lines))}", f"tables/{table}_simulated", lines[0]) if lines else Cell(""))
        rows.append(cells)
    one = first(measured)
    notes = [f"Paper: {first(paper)['paper_source']}." if "paper_source" in paper and not paper.empty else "",
             f"Measured here: {one['scene']} {one['set']}, {shown(one['steps'])} steps and more; speed-ups against scalar, one thread, by interleaved pairs with 95 % intervals. It is another problem "
             "on another machine: compare speed-ups, not seconds. More workers than cores is oversubscribed and has no speed-up." if one is not None else "Nothing was measured here.",
             "Simulated: the paper's problem on nodes as fast as its own, with its exchange, on three networks." if simulated is not None
             else f"Not simulated: run `dssbench experiment {table}`."]
    groups = [("", "", ["configuration"]), ("paper", "paper (published, other machines)", ["time [s]", "speed-up", "row"]),
              ("measured", "measured (here)", ["cell", "median time [s]", "speed-up", "status", "row"]),
              ("simulated", "simulated (the paper's node)", [*[f"{word} [s]" for word in NETWORKS.values()], "rows"])]
    return Grid(name, title, [table, f"{table}_simulated"], groups, rows, [note for note in notes if note])


def table1(results):
    return table_of_processes(results, "table-1", "table1", "Table 1: processes with AVX2-FMA", "avx2")


def table2(results):
    return table_of_processes(results, "table-2", "table2", "Table 2: processes with AVX-512", "avx512")


def table1_host(results):
    """One process with threads, against both bases."""
    measured = measured_rows(results, "table1_host", "speedup_vs_reference", "speedup_vs_scalar", "repetitions", "contaminated")
    rows = []
    for _, row in measured.iterrows():
        scaled = "" if is_missing(row.get("extrapolated_wall_s")) else f"{shown(row['extrapolated_wall_s'])} ({shown(row['extrapolated_to_steps'])})"
        texts = [row["label"], shown(row["steps"]), wall(row), speedup(row, "reference"), speedup(row, "scalar"), f"{shown(row['repetitions'])}, {shown(row['contaminated'])}", row["status"]]
        texts += [scaled, speedup(row, "reference", "extrapolated_"), speedup(row, "scalar", "extrapolated_"), "", ""]
        rows.append([*[Cell(str(text)) for text in texts], reference(row, "tables/table1_host")])
    paper = paper_rows(results, "table1_host")
    for _, row in paper[paper["processes"] == 1].iterrows():
        rows.append([Cell(row["label"]), *[Cell("")] * 9, Cell(shown(row["paper_wall_s"], 6)), Cell(shown(row["paper_speedup"], 4)), reference(row, "tables/table1_host")])
    one = first(measured)
    groups = [("", "", ["configuration"]), ("measured", "measured (here)", ["steps", "median time [s]", "against reference", "against scalar", "repetitions, contaminated", "status"]),
              ("scaled", "scaled from fewer steps", ["time [s] (to steps)", "against reference", "against scalar"]),
              ("paper", "paper (published, other machine)", ["time [s]", "speed-up"]), ("", "", ["row"])]
    notes = [f"{one['scene']} {one['set']}, {one['model']}, {one['precision']}, {one['integrator']}: medians, 95 % intervals, speed-ups by interleaved pairs."] if one is not None else []
    resolution = measured["resolution"].dropna() if "resolution" in measured else pandas.Series(dtype=float)
    if len(resolution):
        notes.append(f"The A/A pair resolves {100 * resolution.iloc[0]:.2g} %: smaller differences are no claim.")
    return Grid("table-1-host", "Table 1 on one process, with threads", ["table1_host"], groups, rows, notes)


def table3(results, name="table-3", title="Table 3: devices and hybrids", link="tables/table3"):
    """Executors by size of the plate."""
    frame = results.table("table3", "source", "label", "set", "measured_wall_s", "extrapolated_wall_s", "extrapolated_to_steps", "steps", "status", "paper_wall_s")
    # The published times of a plate stand above what was measured of it.
    frame = frame.assign(size=frame["set"].str.extract(r"(\d+)", expand=False).astype(float), is_measured=frame["source"] != "paper").sort_values(["size", "is_measured"], kind="stable")
    rows, sizes = [], []
    for _, row in frame.iterrows():
        is_paper = row["source"] == "paper"
        scaled = row["extrapolated_wall_s"]
        cells = [Cell(row["label"]), Cell(shown(row["set"])), Cell(shown(row["paper_wall_s"], 5)) if is_paper else Cell("")]
        time = f"{wall(row)} ({shown(row['steps'])})" if wall(row) else ""
        texts = [time, speedup(row, "scalar"), str(row["status"]), shown(scaled), speedup(row, "scalar", "extrapolated_")]
        cells += [Cell("" if is_paper else text) for text in texts]
        cells.append(reference(row, link))
        rows.append(cells)
        sizes.append(shown(row["set"]))
    groups = [("", "", ["executor", "plate"]), ("paper", "paper (published)", ["10,000 steps [s]"]),
              ("measured", "measured (here)", ["median time [s] (steps)", "against scalar", "status"]), ("scaled", "scaled from fewer steps", ["10,000 steps [s]", "against scalar"]),
              ("", "", ["row"])]
    notes = ["Scaled times are medians of fewer steps times the ratio of steps, and no measurement. A device that is not there is unavailable: nothing else stands in for it.",
             "Table 3 has no simulation; tables/balance.csv is a model of a CPU beside a device."]
    return Grid(name, title, ["table3"], groups, rows, notes, {"Plate": sizes, "Source": list(frame["source"].fillna(""))})


def other_table3(other):
    """Table 3 of another machine, from a folder beside."""
    folder = other.directory.name
    return table3(other, f"table-3-{folder}", f"Table 3 on another machine: {folder}", f"{folder}/tables/table3")


TABLES = [("table-1", "Table 1: processes with AVX2-FMA", "table1", table1), ("table-1-host", "Table 1 on one process, with threads", "table1_host", table1_host),
          ("table-2", "Table 2: processes with AVX-512", "table2", table2), ("table-3", "Table 3: devices and hybrids", "table3", table3)]
