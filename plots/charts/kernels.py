"""Kernels under measured ceilings, and the time of a step by its parts."""
from description import (MARKS, Axis, Chart, Filter, Look, Panel, Series, by_order, colours_of,
                         guide, keys_of, marks_in_words)
from tables.results import NotMeasured
from tables.words import choice, plain, problem, shown

KERNEL_COLUMNS = {
    "cell": "cell", "kernel": "kernel", "model": "model", "precision": "precision",
    "variant": "variant", "level": "level", "threads": "threads",
    "intensity_flop_per_byte": "flop/byte", "flops_per_s": "flop/s", "bytes_per_s": "byte/s",
    "measured_ns_per_element": "ns an element", "measured_ns_per_element_low": "from",
    "measured_ns_per_element_high": "to", "share_of_roof": "share of its roof",
    "limiter": "limiter", "check": "check", "status": "status", "reason": "reason"}
# A step consists of these kernels; the others are parts of them.
WHOLE = ["rk4_step", "rates", "stage_row", "stage_row_last", "stage_row_material",
         "stage_row_material_last"]
ROOFLINE_FILTERS = [
    Filter("precision", "Precision", is_single=True), Filter("threads", "Threads", is_single=True),
    Filter("variant", "Variant"),
    Filter("kernel", "Kernel", first=("whole rows and steps", WHOLE)), Filter("level", "Level"),
    Filter("model", "Model")]
# The instruction set of a variant, if its name is another.
ISA_OF = {"scalar-native": "scalar", "reference": "scalar", "opencl-rhs": "opencl"}
CEILING = "ceiling of "
LEVEL_LINES = ["solid", "dash", "dashdot", "dot"]


def roofs(results, variants, least, most):
    """The ceilings of each variant: the slope of each memory level, up to the peak."""
    try:
        frame = results.table("ceilings", "kind", "benchmark", "isa", "threads", "measured_per_s",
                              optional=["precision", "level"])
    except NotMeasured:
        return
    frame = frame[frame["measured_per_s"].notna()]
    peaks, bandwidths = frame[frame["kind"] == "flops"], frame[frame["kind"] == "bytes"]
    lines = by_order(bandwidths["level"].unique(), LEVEL_LINES)
    best = peaks.groupby(["isa", "precision", "threads"])["measured_per_s"].idxmax()
    for _, peak in peaks.loc[best].iterrows():
        own = bandwidths[bandwidths["threads"] == peak["threads"]]
        # All instruction sets share the memory of the processor; a device has its own.
        is_own = own["isa"] == peak["isa"]
        own = own[is_own] if is_own.any() else own[own["isa"] != "opencl"]
        for variant in [name for name in variants if ISA_OF.get(name, name) == peak["isa"]]:
            for level, rows in own.groupby("level", sort=False):
                slope, top = rows["measured_per_s"].max(), peak["measured_per_s"]
                x = sorted({least, min(max(top / slope, least), most), most})
                keys = {"precision": choice(peak["precision"]), "variant": variant,
                        "threads": choice(peak["threads"]), "level": choice(level)}
                yield guide(f"{CEILING}{level}", [(at, min(top, slope * at)) for at in x],
                            Look("soft", line=lines[level]), entry="measured ceiling", keys=keys)


def roofline(results):
    """Rates of kernels over their intensity, with the ceilings."""
    frame = results.table("kernels", "kernel", "variant", "intensity_flop_per_byte", "flops_per_s",
                          "status", optional=["model", "precision", "level", "threads",
                                              "share_of_roof", "limiter"])
    good = frame[frame["flops_per_s"].notna() & frame["intensity_flop_per_byte"].notna()]
    if good.empty:
        raise NotMeasured("no kernel has a rate")
    # Parts of rows are drawn for one variant: hundreds of points a variant make the page slow.
    fastest = good.loc[good["flops_per_s"].idxmax(), "variant"]
    good = good[good["kernel"].isin(WHOLE) | (good["variant"] == fastest)]
    whole = [name for name in WHOLE if name in set(good["kernel"])]
    colours = colours_of(dict.fromkeys([*whole, *good["kernel"]]))
    looks = {name: Look("soft", mark, size=9)
             for name, mark in by_order(good["variant"].unique(), MARKS).items()}
    intensity = good["intensity_flop_per_byte"]
    series = list(roofs(results, looks, 0.5 * intensity.min(), 2 * intensity.max()))
    has_roof, keys = bool(series), [one.key for one in ROOFLINE_FILTERS]
    levels = ", ".join(dict.fromkeys(f"{one.look.line} {one.name.removeprefix(CEILING)}"
                                     for one in series))
    others = [key for key in keys if key not in ("kernel", "variant")]
    for (kernel, variant, *_), rows in good.groupby(["kernel", "variant", *others], sort=False,
                                                    dropna=False):
        series.append(Series(f"{kernel}, {variant}", rows, "intensity_flop_per_byte",
                             "flops_per_s", looks[variant].but(colour=colours[kernel]),
                             keys_of(rows, *keys), entry=kernel))
    roof = (f"Grey lines are measured ceilings: a slope is the bandwidth of a memory level "
            f"({levels}), a horizontal line the peak of one instruction set." if has_roof
            else "The ceilings were not measured: run `dssbench experiment kernels`.")
    heading = ("Declared flops over the measured time, against declared flops over declared bytes. "
               "A colour is a kernel (some kernels share one), a mark a variant "
               f"({marks_in_words(looks)}). Parts of rows are those of {fastest}; the table "
               f"`kernels.csv` has all. {roof}")
    legend = [(name, Look(colours[name], line="solid", width=4)) for name in whole]
    legend += list(looks.items())
    legend += [(one.name, one.look) for one in series if one.look.line]
    x, y = Axis("flop/byte", "log"), Axis("flop/s", "log")
    return Chart("kernels", good, KERNEL_COLUMNS, [Panel(x, y, series)], heading,
                 closest_to_roof(good), ROOFLINE_FILTERS, ("precision", "threads"), legend=legend,
                 height=540, size=(5, 4), columns_of_facets=2,
                 titles={(precision, threads): f"{precision}, {threads} thread"
                         f"{'s' * (threads != '1')}" for precision, threads in
                         {(one.keys["precision"], one.keys["threads"]) for one in series}})


def closest_to_roof(rows):
    """The kernel with the largest share of its ceiling, in words."""
    if rows["share_of_roof"].isna().all():
        return ""
    best = rows.loc[rows["share_of_roof"].idxmax()]
    limiter = f", held by {best['limiter']}" if shown(best["limiter"]) else ""
    return (f"Closest to its roof is {best['kernel']} of {best['variant']} in "
            f"{best['precision']}, {shown(best['level'])}: {100 * best['share_of_roof']:.0f} %"
            f"{limiter}.")


PART_COLUMNS = {
    "variant": "variant", "model": "model", "precision": "precision", "problem": "scene",
    "threads": "threads", "part": "part", "count_per_step": "a step",
    "measured_ns_per_element_step": "ns an element and step", "share_of_step": "share of the step",
    "share_of_ceiling": "share of its ceiling", "measured_in_l1_ns": "timed alone in L1 [ns]",
    "share_of_ceiling_in_l1": "share of its ceiling, in L1",
    "mix_bound_ns": "bound: its instructions [ns]",
    "mix_without_stack_bound_ns": "bound: its instructions without the stack [ns]",
    "peak_bound_ns": "bound: its flops [ns]", "traffic_bound_ns": "bound: its bytes [ns]",
    "limiter": "limiter", "sum_over_step": "sum of parts over the step"}
PART_FILTERS = [Filter("variant", "Variant"), Filter("model", "Model"),
                Filter("precision", "Precision"), Filter("problem", "Scene"),
                Filter("threads", "Threads")]
HATCHES = ["", "/", "x", ".", "-", "|", "+"]  # parts differ in more than their colours


def attribution(results):
    """The parts of a step as stacked bars; a mark is the step itself."""
    frame = results.table("attribution", "variant", "scene", "part",
                          "measured_ns_per_element_step",
                          optional=["model", "precision", "n", "threads", "sum_over_step"])
    sums = frame["sum_over_step"].dropna()
    frame = frame[frame["measured_ns_per_element_step"].notna()].copy()
    frame["problem"] = [problem(row["scene"], f"n={plain(row['n'])}" if plain(row["n"]) else "")
                        for _, row in frame.iterrows()]
    frame["bar"] = [" ".join(filter(None, (shown(row[name]) for name in (
        "variant", "model", "precision", "problem")))) + f", t{shown(row['threads'])}"
        for _, row in frame.iterrows()]
    keys = [one.key for one in PART_FILTERS]
    is_whole, series = frame["part"] == "step", []
    parts = frame.loc[~is_whole, "part"].unique()
    colours, hatches = colours_of(parts), by_order(parts, HATCHES)
    for (part, *_), rows in frame[~is_whole].groupby(["part", *keys], sort=False, dropna=False):
        series.append(Series(part, rows, "measured_ns_per_element_step", "bar",
                             Look(colours[part], hatch=hatches[part]), keys_of(rows, *keys),
                             kind="bars"))
    for _, rows in frame[is_whole].groupby(keys, sort=False, dropna=False):
        series.append(Series("the step itself", rows, "measured_ns_per_element_step", "bar",
                             Look("ink", "line-ns", size=20), keys_of(rows, *keys)))
    ends = dict.fromkeys(f"{end:.3g}" for end in (sums.min(), sums.max()))
    findings = "" if sums.empty else (f"The parts add up to {' to '.join(ends)} of the step's own "
                                      "time.")
    heading = ("Time of a step for one element, by part. The rest is the step less its row "
               "kernels timed alone. It is below zero, to the left, if the step is faster than "
               "these. Threads: t1 is one thread.")
    bars = list(dict.fromkeys(frame["bar"]))
    panel = Panel(Axis("time of an element and step [ns]"),
                  Axis(scale="category", categories=bars, is_reversed=True), series)
    return Chart("attribution", frame, PART_COLUMNS, [panel], heading, findings, PART_FILTERS,
                 height=180 + 30 * len(bars), size=(7.5, 0.9 + 0.3 * len(bars)))
