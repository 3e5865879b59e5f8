"""Performance portability: how well each application does on all of several platforms.

The words are those of S. J. Pennycook, J. D. Sewall, V. W. Lee: Implications of a metric for
performance portability, Future Generation Computer Systems 92 (2019) 947-958,
doi.org/10.1016/j.future.2017.08.007. A platform is a processor or a GPU. An application is a
variant, with as many threads and ranks as its fastest cell. A problem is a scene with its sizes.
"""
import json
import math
import re

import pandas

from .results import NotMeasured, Results, is_pair
from .words import is_missing, plain, problem, with_interval

PROBLEM = ["scene", "set", "model", "precision", "integrator"]
ENDS = "", "_low", "_high"
# Kinds of efficiency, in words.
KINDS = {"application": "as a part of the fastest one there",
         "architecture": "as a part of the roof of the platform"}


def portability_of(efficiencies, platforms):
    """The harmonic mean over the platforms; 0 if one is missing, NaN if one is unknown."""
    values = list(efficiencies)
    if len(values) < platforms:
        return 0.0
    return math.nan if any(is_missing(one) for one in values) \
        else platforms / sum(1 / one for one in values)


def platform_of(row, context):
    """The GPU of a cell, or the processor. PoCL names the processor as its device."""
    device = plain(row["device_used"])
    if device and context["cpu_model"] not in device:
        return re.sub(r"^\d+:\d+ ", "", device)
    processor = re.sub(r"\(R\)|\(TM\)| Processor", "", context["cpu_model"])
    return f"{' '.join(processor.split())}, {context['num_cpus']} cores"


def rates_of(results, table):
    """The cells of one folder, with columns `platform`, `rate` and `roof` (both in
    element-steps/s); `roof` is empty without a measured one.

    Left out are cells without an interval, the second cells of A/A pairs, and hybrids, which take
    several platforms at once.
    @throws NotMeasured if the table, its circumstances, or all cells are missing
    """
    path = results.directory / "raw" / f"{table}.json"
    try:
        frame = results.table(table, "label", "variant", "status", "scene", "element_steps_per_s",
                              "measured_wall_s", "measured_wall_low_s", "measured_wall_high_s",
                              optional=[*PROBLEM, "device_used", "peak_share", "bandwidth_share"])
        context = json.loads(path.read_text(encoding="utf-8"))["context"]
        rows = frame[(frame["status"] == "ok") & frame["measured_wall_low_s"].notna()
                     & (frame["variant"] != "hybrid")
                     & ~is_pair(frame)].copy()
        rows["platform"] = [platform_of(row, context) for _, row in rows.iterrows()]
        rows["commit"] = context["git_commit"][:8]
    except (NotMeasured, OSError, ValueError) as fault:
        raise NotMeasured(f"{results.directory}, {table}: {fault}") from None
    except KeyError as fault:
        raise NotMeasured(f"{path}: has no {fault}") from None
    if rows.empty:
        raise NotMeasured(f"{results.directory}, {table}: no cell has an interval")
    rows["rate"] = rows["element_steps_per_s"]
    for end, other in (("_low", "_high"), ("_high", "_low")):  # a short time is a high rate
        rows[f"rate{end}"] = rows["rate"] * rows["measured_wall_s"] \
            / rows[f"measured_wall{other}_s"]
    # The roof that binds is the nearer one.
    rows["roof"] = rows["rate"] / rows[["peak_share", "bandwidth_share"]].max(axis=1)
    rows["folder"] = str(results.directory)
    return rows.fillna({name: "" for name in PROBLEM})


def cells_of(folders, table):
    """The cells of all folders. Platforms of one name in two folders get the folder's name.

    @throws NotMeasured if no problem has two platforms
    """
    if len({folder.resolve() for folder in folders}) < len(folders):
        raise NotMeasured("a folder is named twice")
    rows = pandas.concat([rates_of(Results(folder), table) for folder in folders],
                         ignore_index=True)
    folders_of = rows.groupby("platform")["folder"].transform("nunique")
    rows.loc[folders_of > 1, "platform"] += " of " + rows["folder"]
    varied = [name for name in PROBLEM[2:] if rows[name].nunique() > 1]
    rows["problem"] = [problem(row["scene"], row["set"], *row[varied])
                       for _, row in rows.iterrows()]
    several = rows.groupby("problem")["platform"].transform("nunique") > 1
    if not several.any():
        raise NotMeasured("no problem has two platforms: give folders of several machines")
    return rows[several]


def efficiencies(folders, table="table3"):
    """A row for each problem, platform and application: rates and efficiencies, with _low, _high.

    Efficiency of an application: its rate over that of the fastest application for this problem on
    this platform. Efficiency of the architecture: over the rate at which the measured bandwidth of
    the memory or the measured arithmetic is used up; empty if none was measured.
    The intervals take those of both times (95 %) at their worst.
    """
    found = []
    for (name, platform), cells in cells_of(folders, table).groupby(["problem", "platform"],
                                                                    sort=False):
        # Of several cells of an application, each end of the interval is that of the best cell.
        rates = cells.groupby("variant", sort=False)[[f"rate{end}" for end in ENDS]].max()
        for application, own in rates.iterrows():
            others = rates.drop(application).max()
            line = {"problem": name, "platform": platform, "application": application,
                    "commit": cells["commit"].iloc[0]}
            for end, opposite in zip(ENDS, ("", "_high", "_low")):
                rate, other = own[f"rate{end}"], others.get(f"rate{opposite}", math.nan)
                line[f"rate{end}"] = rate
                line[f"application_efficiency{end}"] = \
                    1.0 if is_missing(other) else rate / max(rate, other)
                line[f"architecture_efficiency{end}"] = rate / cells["roof"].max()
            found.append(line)
    return pandas.DataFrame(found)


def portabilities(frame, kind="application"):
    """A row for each problem and application, those of the largest portability first.

    frame: of `efficiencies`. Columns: problem, application, portability with _low and _high, and
    `mean`, the arithmetic mean of the platforms where it was measured.
    """
    tables = []
    for name, rows in frame.groupby("problem", sort=False):
        count, found = rows["platform"].nunique(), []
        for application, own in rows.groupby("application", sort=False):
            line = {"problem": name, "application": application}
            for end in ENDS:
                line[f"portability{end}"] = portability_of(own[f"{kind}_efficiency{end}"], count)
            line["mean"] = own[f"{kind}_efficiency"].mean()
            found.append(line)
        tables.append(pandas.DataFrame(found).sort_values(["portability", "mean"],
                                                          ascending=False, kind="stable"))
    return pandas.concat(tables, ignore_index=True)


def cascade(frame, kind="application"):
    """Known efficiencies with their place: each application has its best platform at 1."""
    ordered = frame[frame[f"{kind}_efficiency"].notna()].sort_values(
        f"{kind}_efficiency", ascending=False, kind="stable").copy()
    ordered["place"] = ordered.groupby(["problem", "application"]).cumcount() + 1
    return ordered


def text_of(row, name):
    """An efficiency with its interval, as people read it."""
    values = [row[f"{name}{end}"] for end in ENDS]
    if is_missing(values[0]):
        return "unknown"
    return with_interval(*(rounded(value) for value in values)) if values[0] else "0"


def rounded(value):
    """Two digits behind the point, or two digits that are not 0."""
    return round(value, 2) if value >= 0.1 else float(f"{value:.2g}")


def table_of(frame, kind="application"):
    """Heads and lines of texts: efficiencies on each platform, and the metric."""
    platforms, lines = list(dict.fromkeys(frame["platform"])), []
    cells = frame.set_index(["problem", "application", "platform"])
    for _, row in portabilities(frame, kind).iterrows():
        places = [(row["problem"], row["application"], platform) for platform in platforms]
        lines.append([row["problem"], f"`{row['application']}`",
                      *(text_of(cells.loc[place], f"{kind}_efficiency") if place in cells.index
                        else "-" for place in places), text_of(row, "portability"),
                      plain(rounded(row["mean"]))])
    return ["problem", "application", *platforms, "portability", "mean where measured"], lines
