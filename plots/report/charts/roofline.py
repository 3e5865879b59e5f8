"""Kernels under the ceilings that were measured in the same session."""
from ..results import NotMeasured
from ..words import choice, shown
from .chart import OKABE_ITO, SYMBOLS, Chart, Filter, by_order, logarithmic, plain, points

COLUMNS = {"cell": "cell", "kernel": "kernel", "model": "model", "precision": "precision", "variant": "variant", "level": "level", "threads": "threads", "intensity_flop_per_byte": "flop/byte",
           "flops_per_s": "flop/s", "bytes_per_s": "byte/s", "measured_ns_per_element": "ns an element", "measured_ns_per_element_low": "from", "measured_ns_per_element_high": "to",
           "share_of_roof": "share of its roof", "limiter": "limiter", "check": "check", "status": "status", "reason": "reason"}
WHOLE = ["rk4_step", "rates", "stage_row", "stage_row_last"]  # what a step is made of; the other kernels are parts of these
FILTERS = [Filter("precision", "Precision", is_single=True), Filter("threads", "Threads", is_single=True), Filter("variant", "Variant"), Filter("kernel", "Kernel", first=("whole rows and steps", WHOLE)), Filter("level", "Level"),
           Filter("model", "Model")]
# Whose instructions a variant is made of; others are of their own name.
ISA_OF = {"scalar-native": "scalar", "reference": "scalar", "opencl-rhs": "opencl"}


def ceilings(results, variants, least, most):
    """Lines of what the machine was measured to do at most: of each instruction set the sloping part of each level up to its peak."""
    try:
        frame = results.table("ceilings", "kind", "benchmark", "isa", "precision", "level", "threads", "measured_per_s", "status")
    except NotMeasured:
        return []
    frame = frame[frame["measured_per_s"].notna()]
    peaks, bandwidths = frame[frame["kind"] == "flops"], frame[frame["kind"] == "bytes"]
    traces, levels = [], by_order(bandwidths["level"].unique(), ["solid", "dash", "dashdot", "dot"])
    for _, peak in peaks.loc[peaks.groupby(["isa", "precision", "threads"])["measured_per_s"].idxmax()].iterrows():
        own = bandwidths[bandwidths["threads"] == peak["threads"]]
        # Levels of the processor are everybody's; a device's are its own.
        own = own[own["isa"] == peak["isa"]] if (own["isa"] == peak["isa"]).any() else own[own["isa"] != "opencl"]
        for variant in [name for name in variants if ISA_OF.get(name, name) == peak["isa"]]:
            for level, rows in own.groupby("level", sort=False):
                slope = rows.loc[rows["measured_per_s"].idxmax()]
                knee = peak["measured_per_s"] / slope["measured_per_s"]
                x = sorted({least, min(max(knee, least), most), most})
                traces.append({"type": "scatter", "mode": "lines", "x": plain(x), "y": plain([min(peak["measured_per_s"], slope["measured_per_s"] * value) for value in x]),
                               "name": f"roof, {level}", "legendgroup": f"roof {level}", "line": {"color": "soft", "width": 1.5, "dash": levels[level]},
                               "meta": {"precision": choice(peak["precision"]), "threads": choice(peak["threads"]), "variant": variant, "level": choice(level)},
                               "hovertemplate": f"{variant}: {peak['benchmark']} tables/ceilings.csv:{peak['line']}, {level} {slope['benchmark']} tables/ceilings.csv:{slope['line']}<extra></extra>"})
    return traces


def roofline(results):
    frame = results.table("kernels", "kernel", "model", "precision", "variant", "level", "threads", "intensity_flop_per_byte", "flops_per_s", "share_of_roof", "limiter", "status")
    good = frame[frame["flops_per_s"].notna() & frame["intensity_flop_per_byte"].notna()]
    if good.empty:
        raise NotMeasured("no kernel has a rate")
    kernels = list(dict.fromkeys([name for name in WHOLE if name in set(good["kernel"])] + list(good["kernel"])))
    colours, symbols = by_order(kernels, OKABE_ITO), by_order(good["variant"].unique(), SYMBOLS)
    traces = ceilings(results, list(symbols), 0.5 * good["intensity_flop_per_byte"].min(), 2 * good["intensity_flop_per_byte"].max())
    has_roof = bool(traces)
    for (kernel, variant, *_), rows in good.groupby(["kernel", "variant", "precision", "threads", "level", "model"], sort=False, dropna=False):
        traces.append(points(rows, "kernels", "intensity_flop_per_byte", "flops_per_s", ["kernel", "variant", "precision", "threads", "level", "model"], COLUMNS, mode="markers", name=kernel,
                             legendgroup=kernel, marker={"size": 9, "color": colours[kernel], "symbol": symbols[variant]}))
    marks = ", ".join(f"{symbol.replace('-', ' ')} {variant}" for variant, symbol in symbols.items())
    best = good.loc[good["share_of_roof"].idxmax()] if good["share_of_roof"].notna().any() else None
    words = ""
    if best is not None:
        limiter = f", held by {best['limiter']}" if shown(best["limiter"]) else ""
        words = f" Closest to its roof is {best['kernel']} of {best['variant']} in {best['precision']}, {shown(best['level'])}: {100 * best['share_of_roof']:.0f} %{limiter}."
    roof = "Grey lines are ceilings as measured in this session, by memory level." if has_roof else "The ceilings were not measured: run `dssbench experiment kernels`."
    text = f"Declared flops over the measured time, against declared flops over bytes. A colour is a kernel (of all at once some share one), a mark a variant ({marks}). {roof}{words}"
    layout = {"xaxis": logarithmic("flop/byte"), "yaxis": logarithmic("flop/s")}
    return Chart(text, "kernels", traces, layout, frame, COLUMNS, FILTERS, height=540)
