"""Tables 1 to 3 of the paper. Published, measured and simulated values have their own columns."""
import dataclasses

from tables.words import is_missing, shown, with_interval

WAYS = ("as the paper did", "our best")


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


def figure_of(row, table):
    """The cells of one way: the figure with its interval, what ran, and its row."""
    if row is None:
        return cells_of([""] * 3)
    measured = with_interval(row.get("measured"), row.get("measured_low"), row.get("measured_high"))
    scaled = "~ " if measured and row.get("scaled") == "yes" else ""
    ran = "" if is_missing(row.get("ran")) else row["ran"]
    status = "" if row["status"] == "ok" else row["status"]
    return [*cells_of([scaled + measured, "; ".join(filter(None, [ran, status]))]),
            reference(f"tables/{table}", row)]


def paper_grid(results, name, table, title):
    """A table of the paper: a line for each of its figures, in its order."""
    frame = results.table(table, "row", "column", "way", "unit", "paper", "status", optional=[
        "base", "measured", "measured_low", "measured_high", "ran", "machine", "set", "steps",
        "scaled", "simulated_paper_node", "simulated_own_node"])
    frame = frame.assign(base=frame["base"].fillna(""))
    rows, resources = [], []
    for (resource, column, base), group in frame.groupby(["row", "column", "base"], sort=False):
        ways = [first(group[group["way"] == way]) for way in WAYS]
        if (group["way"] == "the base").any():
            ways[0] = first(group)
        one = first(group)
        simulated = [shown(row[node], 4) if row is not None else ""
                     for node in ("simulated_paper_node", "simulated_own_node") for row in ways]
        unit = "" if one["unit"] == "ratio" else " [s]"
        rows.append([*cells_of([resource, f"{column}{unit}", base, shown(one["paper"], 6)]),
                     *figure_of(ways[0], table), *figure_of(ways[1], table),
                     *cells_of(simulated)])
        resources.append(resource)
    groups = [("", "", ["row", "figure", "base"]), ("paper", "paper (published)", ["figure"]),
              ("measured", "measured: as the paper did, or the base", ["figure", "ran", "csv"]),
              ("measured", "measured: our best", ["figure", "ran", "csv"]),
              ("simulated", "simulated: nodes as fast as the paper's", ["its way", "our best"]),
              ("simulated", "simulated: nodes with its cores, each as fast as here",
               ["its way", "our best"])]
    machines = "; ".join(dict.fromkeys(frame["machine"].dropna()))
    notes = ["Rows and columns are the paper's, in its order. A speed-up has a line for each base, "
             "the plain code that it refers to. Medians with 95 % intervals; ~ scaled to the "
             "paper's steps from fewer. A figure without an interval is left out.",
             f"Measured on: {machines}." if machines else "Nothing was measured here."]
    filters = {"Row": resources} if len(set(resources)) > 1 else {}
    return Grid(name, title, [table], groups, rows, notes, filters)


def table1(results):
    """Table 1."""
    return paper_grid(results, "table-1", "paper_table1", "Table 1: processes with AVX2-FMA")


def table2(results):
    """Table 2."""
    return paper_grid(results, "table-2", "paper_table2", "Table 2: processes with AVX-512")


def table3(results):
    """Table 3."""
    return paper_grid(results, "table-3", "paper_table3", "Table 3: CPU, GPU, and both")


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
    "tables/balance.csv has a model of a CPU beside a device."]


def table3_texts(row):
    """The texts of a published or a measured row in TABLE3_GROUPS."""
    if row["source"] == "paper":
        return [shown(row["paper_wall_s"], 5), *[""] * 5]
    time = f"{wall(row)} ({shown(row['steps'])})" if wall(row) else ""
    return ["", time, speedup(row, "scalar"), row["status"], shown(row["extrapolated_wall_s"]),
            speedup(row, "scalar", "extrapolated_")]


def executors(results, name="table-3-executors", title="Executors by size of the plate",
              path="tables/table3"):
    """Every executor of the study table3. path: of the table, without .csv"""
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
    return executors(other, f"table-3-{folder}", f"Table 3 on another machine: {folder}",
                     f"{folder}/tables/table3")


TABLES = [("table-1", "Table 1: processes with AVX2-FMA", "paper_table1", table1),
          ("table-2", "Table 2: processes with AVX-512", "paper_table2", table2),
          ("table-3", "Table 3: CPU, GPU, and both", "paper_table3", table3),
          ("table-1-host", "One process, with threads", "table1_host", table1_host),
          ("table-3-executors", "Executors by size of the plate", "table3", executors)]
