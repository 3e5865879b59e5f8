"""Tables 1 to 3 of the paper. Published, measured and simulated values have their own columns."""
import dataclasses

from tables.results import NotMeasured
from tables.words import is_missing, shown, with_interval

NETWORKS = {"gigabit": "1 GbE", "ten_gigabit": "10 GbE", "fdr": "FDR"}


@dataclasses.dataclass
class Cell:
    """A text and its row: a path from the directory of results, without .csv, and a line."""
    text: str
    table: str = ""
    line: int = 0


@dataclasses.dataclass
class Grid:
    """A table whose columns are in groups.

    groups: (kind, heading, columns); kind is "", paper, measured, scaled or simulated.
    filters: by label, a value for each row.
    """
    name: str
    title: str
    tables: list
    groups: list
    rows: list
    notes: list
    filters: dict = dataclasses.field(default_factory=dict)


def measured_rows(results, table, *needed, optional=()):
    """Rows that were measured here."""
    frame = results.table(table, "source", "label", "set", "steps", "status", *needed,
                          optional=["measured_wall_s", *optional])
    return frame[frame["source"] == "measured"]


def paper_rows(results, table):
    """Published rows, with their number of processes."""
    frame = results.table(table, "source", "label", optional=["paper_wall_s", "paper_speedup"])
    frame = frame[frame["source"] == "paper"].copy()
    processes = frame["label"].str.extract(r"^(\d+) process", expand=False)
    frame["processes"] = processes.astype(float)
    frame["is_base"] = frame["label"].str.contains("no vectorisation", regex=False)
    return frame


def first(frame):
    """The first row, or none."""
    return None if frame.empty else frame.iloc[0]


def cells_of(texts):
    """Cells that refer to no row."""
    return [Cell(str(text)) for text in texts]


def reference(table, *rows):
    """A cell that names the lines of rows in a table; empty if there are none."""
    if not rows:
        return Cell("")
    lines = [int(row["line"]) for row in rows]
    name = table.removeprefix("tables/")
    return Cell(f"{name}.csv:{', '.join(map(str, lines))}", table, lines[0])


def wall(row):
    """The median time with its interval [s]."""
    return with_interval(row["measured_wall_s"], row.get("measured_wall_low_s"),
                         row.get("measured_wall_high_s"))


def speedup(row, base, before=""):
    """The speed-up against `base` with its interval; empty if there are more workers than cores.

    before: "extrapolated_" for a speed-up that is scaled from fewer steps
    """
    column = f"{before}speedup_vs_{base}"
    return with_interval(row.get(column), row.get(f"{column}_low"), row.get(f"{column}_high"))


def simulated_rows(results, table):
    """Simulated rows with the paper's cluster and its exchange; none if nothing was simulated."""
    try:
        frame = results.table(f"{table}_simulated", "label", "ranks", "network", "halo",
                              "simulated_paper_node_wall_s")
    except NotMeasured:
        return None
    is_papers = frame["label"].str.startswith("the paper's cluster", na=False)
    return frame[is_papers & (frame["halo"] == "sendrecv")]


def own_rows(measured, variant):
    """Rows of strong scaling on one thread a rank: weak scaling has plates of other sizes."""
    is_pair = measured["label"].str.contains("A/A", regex=False)
    own = measured[(measured["variant"] == variant) & (measured["threads"] == 1) & ~is_pair]
    return own if own.empty else own[own["set"] == own["set"].iloc[0]]


def counterpart(published, measured, own):
    """The measured row that is beside a published one, or none."""
    if published["is_base"]:
        return first(measured[(measured["variant"] == "scalar") & (measured["threads"] == 1)])
    own = own[own["ranks"] == published["processes"]]
    is_auto = own["halo"] == "auto"
    return first(own[is_auto] if is_auto.any() else own)


def measured_cells(row, table):
    """Cells of a measured row; empty ones if there is none."""
    if row is None:
        return cells_of([""] * 5)
    texts = [row["label"], wall(row), speedup(row, "scalar"), row["status"]]
    return [*cells_of(texts), reference(f"tables/{table}", row)]


def simulated_cells(published, simulated, table):
    """Cells of the simulated times on each network; empty ones if there are none."""
    if simulated is None or published["is_base"]:
        return cells_of([""] * (len(NETWORKS) + 1))
    alike = simulated[simulated["ranks"] == published["processes"]]
    rows = [first(alike[alike["network"] == network]) for network in NETWORKS]
    texts = ["" if row is None else shown(row["simulated_paper_node_wall_s"], 4) for row in rows]
    known = [row for row in rows if row is not None]
    return [*cells_of(texts), reference(f"tables/{table}_simulated", *known)]


def notes_of_processes(table, paper, measured, has_simulation):
    """Where the values of Table 1 or 2 are from, and what may be compared."""
    notes = []
    if "paper_source" in paper and not paper.empty:
        notes.append(f"Paper: {first(paper)['paper_source']}.")
    one = first(measured)
    notes.append(
        "Nothing was measured here." if one is None else
        f"Measured here: {one['scene']} {one['set']}, at least {shown(one['steps'])} steps. "
        "Speed-ups are against scalar on one thread, by interleaved pairs, with 95 % intervals. "
        "Problem and machine differ from the paper's: compare speed-ups, not seconds. A row with "
        "more workers than cores is oversubscribed and has no speed-up.")
    notes.append(
        "Simulated: the paper's problem and its exchange, on nodes as fast as the paper's, on "
        "three networks." if has_simulation else
        f"Not simulated: run `dssbench experiment {table}`.")
    return notes


def table_of_processes(results, name, table, title, variant):
    """Table 1 or 2: a row for each published number of processes."""
    measured = measured_rows(results, table, "ranks", "threads", "halo", "variant")
    paper = paper_rows(results, table)
    if paper.empty and measured.empty:
        raise NotMeasured(f"tables/{table}.csv has no rows")
    simulated, own = simulated_rows(results, table), own_rows(measured, variant)
    rows = []
    for _, published in paper.iterrows():
        texts = [published["label"], shown(published["paper_wall_s"], 6),
                 shown(published["paper_speedup"], 4)]
        rows.append([*cells_of(texts), reference(f"tables/{table}", published),
                     *measured_cells(counterpart(published, measured, own), table),
                     *simulated_cells(published, simulated, table)])
    networks = [f"{word} [s]" for word in NETWORKS.values()]
    groups = [("", "", ["configuration"]),
              ("paper", "paper (published, other machines)", ["time [s]", "speed-up", "row"]),
              ("measured", "measured (here)",
               ["cell", "median time [s]", "speed-up", "status", "row"]),
              ("simulated", "simulated (the paper's node)", [*networks, "rows"])]
    return Grid(name, title, [table, f"{table}_simulated"], groups, rows,
                notes_of_processes(table, paper, measured, simulated is not None))


def table1(results):
    """Table 1."""
    return table_of_processes(results, "table-1", "table1", "Table 1: processes with AVX2-FMA",
                              "avx2")


def table2(results):
    """Table 2."""
    return table_of_processes(results, "table-2", "table2", "Table 2: processes with AVX-512",
                              "avx512")


HOST_GROUPS = [
    ("", "", ["configuration"]),
    ("measured", "measured (here)", ["steps", "median time [s]", "against reference",
                                     "against scalar", "repetitions, contaminated", "status"]),
    ("scaled", "scaled from fewer steps", ["time [s] (to steps)", "against reference",
                                           "against scalar"]),
    ("paper", "paper (published, other machine)", ["time [s]", "speed-up"]),
    ("", "", ["row"])]


def host_texts(row):
    """The texts of a measured row in HOST_GROUPS."""
    scaled = ""
    if not is_missing(row["extrapolated_wall_s"]):
        scaled = f"{shown(row['extrapolated_wall_s'])} ({shown(row['extrapolated_to_steps'])})"
    return [row["label"], shown(row["steps"]), wall(row), speedup(row, "reference"),
            speedup(row, "scalar"), f"{shown(row['repetitions'])}, {shown(row['contaminated'])}",
            row["status"], scaled, speedup(row, "reference", "extrapolated_"),
            speedup(row, "scalar", "extrapolated_"), "", ""]


def table1_host(results):
    """Table 1 on one process with threads, against both bases."""
    table = "table1_host"
    measured = measured_rows(results, table, "repetitions", optional=[
        "contaminated", "extrapolated_wall_s", "extrapolated_to_steps", "resolution"])
    rows = [[*cells_of(host_texts(row)), reference(f"tables/{table}", row)]
            for _, row in measured.iterrows()]
    paper = paper_rows(results, table)
    for _, row in paper[paper["processes"] == 1].iterrows():
        texts = [row["label"], *[""] * 9, shown(row["paper_wall_s"], 6),
                 shown(row["paper_speedup"], 4)]
        rows.append([*cells_of(texts), reference(f"tables/{table}", row)])
    one, notes = first(measured), []
    if one is not None:
        notes.append(f"{one['scene']} {one['set']}, {one['model']}, {one['precision']}, "
                     f"{one['integrator']}. Times are medians with 95 % intervals; speed-ups are "
                     "by interleaved pairs.")
    resolution = measured["resolution"].dropna()
    if len(resolution):
        notes.append(f"The resolution is {100 * resolution.iloc[0]:.2g} %, by the A/A pair (one "
                     "cell measured as if it were two). A smaller difference proves nothing.")
    return Grid("table-1-host", "Table 1 on one process, with threads", [table], HOST_GROUPS,
                rows, notes)


TABLE3_GROUPS = [
    ("", "", ["executor", "plate"]),
    ("paper", "paper (published)", ["10,000 steps [s]"]),
    ("measured", "measured (here)", ["median time [s] (steps)", "against scalar", "status"]),
    ("scaled", "scaled from fewer steps", ["10,000 steps [s]", "against scalar"]),
    ("", "", ["row"])]
TABLE3_NOTES = [
    "A scaled time is the median of fewer steps times the ratio of the steps. It is no "
    "measurement. A device that is not there is unavailable; nothing else stands in for it.",
    "Table 3 has no simulation; tables/balance.csv has a model of a CPU beside a device."]


def table3_texts(row):
    """The texts of a published or a measured row in TABLE3_GROUPS."""
    if row["source"] == "paper":
        return [shown(row["paper_wall_s"], 5), *[""] * 5]
    time = f"{wall(row)} ({shown(row['steps'])})" if wall(row) else ""
    return ["", time, speedup(row, "scalar"), row["status"], shown(row["extrapolated_wall_s"]),
            speedup(row, "scalar", "extrapolated_")]


def table3(results, name="table-3", title="Table 3: devices and hybrids", path="tables/table3"):
    """Table 3: executors by the size of the plate. path: of the table, without .csv"""
    frame = results.table("table3", "source", "label", "set", "steps", "status", optional=[
        "measured_wall_s", "extrapolated_wall_s", "paper_wall_s"])
    size = frame["set"].str.extract(r"(\d+)", expand=False).astype(float)
    frame = frame.assign(size=size, is_measured=frame["source"] != "paper")
    # The published times of a plate stand above the measured ones.
    frame = frame.sort_values(["size", "is_measured"], kind="stable")
    rows = [[*cells_of([row["label"], shown(row["set"]), *table3_texts(row)]),
             reference(path, row)] for _, row in frame.iterrows()]
    filters = {"Plate": [shown(plate) for plate in frame["set"]],
               "Source": list(frame["source"].fillna(""))}
    return Grid(name, title, ["table3"], TABLE3_GROUPS, rows, TABLE3_NOTES, filters)


def other_table3(other):
    """Table 3 of another machine, from a folder of the results."""
    folder = other.directory.name
    return table3(other, f"table-3-{folder}", f"Table 3 on another machine: {folder}",
                  f"{folder}/tables/table3")


TABLES = [("table-1", "Table 1: processes with AVX2-FMA", "table1", table1),
          ("table-1-host", "Table 1 on one process, with threads", "table1_host", table1_host),
          ("table-2", "Table 2: processes with AVX-512", "table2", table2),
          ("table-3", "Table 3: devices and hybrids", "table3", table3)]
