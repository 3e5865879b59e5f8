"""Tables that pages quote, by the name in their marks (quotes.py).

A function takes Results, and returns the heads and the lines of texts.
"""
import json

from body_tables import geometry_table, schedules_table, shapes_table
from goal_tables import goals_table
from tables import portability
from tables.results import NotMeasured, Results, is_pair
from tables.words import speedup_over, with_interval


def disturbed(row):
    """How many repetitions other programs disturbed."""
    return f"{int(row['contaminated'])} of {int(row['repetitions'])}"


def chain_table(results):
    """The chain of factors, a line for each stage."""
    ratios = [f"{name}{end}" for name in ("factor_of_stage", "factor_vs_base")
              for end in ("", "_low", "_high")]
    frame = results.table("chain", "stage", "role", "label", "variant", "threads", "model",
                          "precision", "integrator", "dt_s", "error_max", "contaminated",
                          "repetitions", optional=ratios)
    keys = ["variant", "threads", "model", "precision", "integrator", "dt_s"]
    lines, before = [], None
    for _, row in frame.iterrows():
        new = [key for key in keys if before is None or row[key] != before[key]]
        threads = f"{row['threads']} thread{'s' if row['threads'] > 1 else ''}"
        run = ", ".join({"threads": threads, "dt_s": f"{row['dt_s']:.3g} s"}
                        .get(key, f"`{row[key]}`") for key in new)
        factor = with_interval(row["factor_of_stage"], row["factor_of_stage_low"],
                               row["factor_of_stage_high"])
        in_all = with_interval(row["factor_vs_base"], row["factor_vs_base_low"],
                               row["factor_vs_base_high"])
        beside = "*beside:* " if row["role"] == "neighbour" else ""
        lines.append([beside + row["label"], run, factor, in_all, disturbed(row),
                      f"{row['error_max']:.1e}"])
        before = row
    return ["stage of the chain", "run", "factor", "in all", "contaminated", "error"], lines


def first_table(results):
    """Table 1 of the paper on this machine: one process."""
    frame = results.table("table1", "source", "label", "variant", "threads", "ranks", "status",
                          "contaminated", "repetitions", "measured_wall_s", "steps")
    frame = frame[(frame["source"] == "measured") & (frame["ranks"] == 1)
                  & ~is_pair(frame) & (frame["status"] == "ok")]
    bases = ("as_published", "reference", "scalar")

    lines = [[row["label"], f"{1e3 * row['measured_wall_s'] / row['steps']:.3g}",
              *(speedup_over(row, base) for base in bases), disturbed(row)]
             for _, row in frame.iterrows()]
    return ["variant", "ms a step", *(f"over `{base}`" for base in bases), "contaminated"], lines


def machine_table(results):
    """The machine and the build of Table 1, as its circumstances have them."""
    path = results.directory / "raw" / "table1.json"
    if not path.exists():
        raise NotMeasured(f"{path} is missing")
    context = json.loads(path.read_text())["context"]
    caches = {(each["level"], each["type"]): each["size"] for each in context["caches"]}
    l2 = caches.get((2, "Unified"))
    return ["CPU", "cores", "L2 of a core", "memory", "compiler", "commit", "date"], [[
        context["cpu_model"], str(context["num_cpus"]),
        "" if l2 is None else f"{l2 / 2**20:.3g} MiB", f"{context['memory_bytes'] / 2**30:.0f} GiB",
        f"{context['compiler']}, {context['compiler_flags']}", context["git_commit"][:7],
        context["date"][:10]]]


def gpu_table(results):
    """The paper's CPU and its GPU, all cores of a CPU and an H100: seconds of 10,000 steps."""
    frame = Results(results.directory / "h100").table(
        "table3", "label", "set", "measured_wall_s", "measured_wall_low_s", "measured_wall_high_s",
        "steps", "threads", "variant", optional=["paper_wall_s"])
    lines = []
    for plate in ("n=50", "n=100", "n=200"):
        rows = frame[frame["set"] == plate]
        paper = rows.set_index("label")["paper_wall_s"]
        cpu = rows[rows["variant"] == "avx512"].nlargest(1, "threads").iloc[0]
        gpu = rows[rows["label"] == "opencl on gpu, 1 thread"].iloc[0]
        times = [with_interval(*(row[f"measured_wall{end}_s"] / row["steps"] * 10000
                                 for end in ("", "_low", "_high"))) for row in (cpu, gpu)]
        lines.append([plate, f"{paper['two CPU processes']:.2f}", f"{paper['P100 alone']:.2f}",
                      *times])
    return ["plate", "paper: two CPU processes", "P100", "`avx512`, 16 threads", "H100"], lines


def portability_table(results):
    """Pennycook's metric over the machines whose results are here, for the largest plate."""
    folders = [one.directory for one in (results, *results.others())]
    frame = portability.efficiencies(folders)
    heads, lines = portability.table_of(frame[frame["problem"].str.endswith(" n=200")])
    return heads[1:], [line[1:] for line in lines]


def network_table(results):
    """The paper's times beside simulated ones with the speed of its own nodes."""
    lines = []
    for table in ("table1", "table2"):
        frame = results.table(f"{table}_simulated", "label", "ranks", "network", "halo",
                              "paper_wall_s", "simulated_paper_node_wall_s")
        frame = frame[frame["label"].str.startswith("the paper's cluster")
                      & (frame["halo"] == "sendrecv") & (frame["ranks"] > 1)]
        for ranks, rows in frame.groupby("ranks"):
            paper = rows["paper_wall_s"].iloc[0]
            times = rows.set_index("network")["simulated_paper_node_wall_s"]
            lines.append([f"Table {table[-1]}, {ranks} processes", f"{paper:g}",
                          *(f"{times[name]:.1f} ({100 * (times[name] / paper - 1):+.0f} %)"
                            for name in ("gigabit", "ten_gigabit", "fdr"))])
    return ["", "published", "1 GbE", "10 GbE", "FDR"], lines


def sizes_table(results):
    """Efficiency of six simulated nodes over the size of the plate."""
    frame = results.table("cluster_simulated", "label", "set", "network", "halo",
                          "simulated_own_node_efficiency")
    frame = frame[(frame["label"] == "sizes") & (frame["halo"] == "auto")]
    sizes = list(dict.fromkeys(frame["set"]))
    lines = []
    for network, name in (("gigabit", "1 GbE"), ("ten_gigabit", "10 GbE"), ("fdr", "FDR")):
        rows = frame[frame["network"] == network].set_index("set")
        lines.append([name, *(f"{rows.loc[size, 'simulated_own_node_efficiency']:.2f}"
                              for size in sizes)])
    return ["elements a side", *(size.removeprefix("n=") for size in sizes)], lines


def mix_table(results):
    """Instructions of a pack of the spatial row, and its time beside that of these alone."""
    variants = ["scalar", "avx2", "avx512"]
    frame = results.table("attribution", "variant", "model", "precision", "part", "fma",
                          "peak_bound_ns", "mix_bound_ns", "measured_in_l1_ns")
    frame = frame[(frame["model"] == "spatial") & (frame["precision"] == "f64")
                  & (frame["part"] == "stage_row")].set_index("variant")
    rows = [frame.loc[variant] for variant in variants]
    texts = (
        ("fused multiply-adds", lambda row: f"{row['fma']:.0f}"),
        ("sums and products", lambda row: f"{row['sums'] + row['products']:.0f}"),
        ("lane shifts", lambda row: f"{row['shuffles']:.0f}"),
        ("loads (of them of spilled registers)",
         lambda row: f"{row['loads']:.0f} ({row['stack_loads']:.0f})"),
        ("stores (of them of spilled registers)",
         lambda row: f"{row['stores']:.0f} ({row['stack_stores']:.0f})"),
        ("time of the fused multiply-adds alone (scalar: sums and products)",
         lambda row: f"{row['peak_bound_ns']:.1f}"),
        ("time of the mix without spilled registers",
         lambda row: f"{row['mix_without_stack_bound_ns']:.1f}"),
        ("**time of the mix as executed**", lambda row: f"{row['mix_bound_ns']:.1f}"),
        ("**measured time of the row**", lambda row: f"{row['measured_in_l1_ns']:.1f}"),
        ("time of the mix over measured time",
         lambda row: f"{row['share_of_ceiling_in_l1']:.2f}"))
    lines = [[name, *(text(row) for row in rows)] for name, text in texts]
    return ["", "scalar", "AVX2", "AVX-512"], lines


def continuum_table(results):
    """Errors of the finest grids and of the limits of grids, over all modes of a check."""
    frame = results.table("continuum", "check", "mode", "value", "error",
                          optional=["set", "limit_error"])
    lines = []
    for check, rows in frame.groupby("check", sort=False):
        finest = rows.loc[rows.groupby("mode")["value"].idxmax()]
        ends = [[f"{number:+.0e}" for number in (column.min(), column.max())]
                if column.notna().any() else [""]  # two grids have no limit
                for column in (finest["error"], finest["limit_error"])]
        lines.append([f"`{check}`", *(" to ".join(dict.fromkeys(pair)) for pair in ends)])
    return ["check", "finest grid against theory", "limit by Richardson against theory"], lines


def models_table(results):
    """Rates of whole steps by model and precision, over those of spatial in f64."""
    models = [("spatial", "f64"), ("planar", "f64"), ("planar", "f32"), ("membrane", "f64")]
    frame = results.table("kernels", "kernel", "model", "precision", "variant", "threads", "n",
                          "flops_per_element", "measured_ns_per_element")
    frame = frame[(frame["kernel"] == "rk4_step") & (frame["variant"] == "avx512")
                  & (frame["threads"] == 1)].set_index(["n", "model", "precision"])
    lanes = [2 if precision == "f32" else 1 for *_, precision in frame.index]
    frame = frame.assign(flops_by_lanes=frame["flops_per_element"] / lanes)

    def over_spatial(column, n):
        costs = [frame.loc[(n, *model), column] for model in models]
        return [f"{costs[0] / cost:.2f}" for cost in costs]

    lines = [["predicted: ratio of flops", *over_spatial("flops_by_lanes", 100)]]
    lines += [[f"n = {n}", *over_spatial("measured_ns_per_element", n)] for n in (100, 300)]
    return ["", *(f"{model}, {precision}" for model, precision in models)], lines


def statics_table(results):
    """Times to a linear state of rest by solver, of the largest case of each scene."""
    solvers = ["direct", "cg, incomplete Cholesky", "cg, block Jacobi"]
    frame = results.table("statics", "scene", "loads", "elements", "unknowns", "solver", "wall_s")
    frame = frame[frame["solver"].isin(solvers) & (frame["loads"] == 1)]
    lines = []
    for scene, rows in frame.groupby("scene", sort=False):
        rows = rows[rows["unknowns"] == rows["unknowns"].max()].set_index("solver")
        first = rows.iloc[0]
        lines.append([f"`{scene}`", f"{int(first['elements'])}", f"{int(first['unknowns'])}",
                      *(f"{1e3 * rows.loc[solver, 'wall_s']:.3g} ms" for solver in solvers)])
    return ["scene", "elements", "unknowns", "factors", *solvers[1:]], lines


def verification_table(results):
    """Published problems: their figures, and the parts of the error."""
    frame = results.table("verification", "problem", "figure", "unit", "reference", "extrapolated",
                          "extrapolated_uncertainty", "order", "grid_error", "model_error",
                          "status", optional=["time_error"])
    frame = frame[frame["reference"].notna()]

    def part(value):
        return "" if value != value else f"{value:+.2%}"

    lines = [[f"[`{row['problem']}`](problems/{row['problem']}.md)",
              f"{row['figure']} [{row['unit']}]", f"{row['reference']:.6g}",
              f"{row['extrapolated']:.6g} ± {row['extrapolated_uncertainty']:.1g}",
              "no order" if row["order"] != row["order"] else part(row["grid_error"]),
              part(row["model_error"]), part(row["time_error"]), row["status"]]
             for _, row in frame.iterrows()]
    return ["problem", "figure", "reference", "extrapolated", "grid", "model", "time", ""], lines


def problem_table(results, problem):
    """Figures of a published problem by grid, extrapolated, and as published."""
    grids = results.table("verification_grids", "problem", "figure", "refined", "value",
                          "elements", "result", "unit")
    whole = results.table("verification", "problem", "figure", "extrapolated",
                          "extrapolated_uncertainty", "reference", "order", "model_error",
                          "status")
    grids, whole = (frame[frame["problem"] == problem] for frame in (grids, whole))
    if grids.empty:
        raise NotMeasured(f"verification_grids has no problem {problem}")
    names = list(dict.fromkeys(f"{row['figure']} [{row['unit']}]" for _, row in grids.iterrows()))
    lines = [[f"{value:g}", f"{rows['elements'].iloc[0]}",
              *(f"{result:.6g}" for result in rows["result"])]
             for value, rows in grids.groupby("value")]
    last = {"extrapolated": lambda row: f"{row['extrapolated']:.6g} ± "
                                        f"{row['extrapolated_uncertainty']:.1g}",
            "reference": lambda row: f"{row['reference']:.6g}",
            "difference": lambda row: f"{row['model_error']:+.2%}",
            "order": lambda row: "none" if row["order"] != row["order"] else f"{row['order']:.1f}",
            "verdict": lambda row: row["status"]}
    for name, text in last.items():
        words = [text(row) for _, row in whole.iterrows()]
        if not all("nan" in word for word in words):
            lines.append([f"**{name}**", "", *("" if "nan" in word else word for word in words)])
    return [grids["refined"].iloc[0], "elements", *names], lines


def implicit_table(results):
    """The cheapest explicit and the cheapest implicit run within a tolerance.

    What comes before the steps (factors, rows) counts too.
    """
    frame = results.table("implicit", "scene", "set", "variant", "integrator", "steps",
                          "error_max", "measured_wall_s", "first_step_s", "status")
    frame = frame[frame["status"] == "ok"].copy()
    frame["whole_s"] = frame["measured_wall_s"] + frame["first_step_s"]
    lines = []
    for (scene, size), rows in frame.groupby(["scene", "set"], sort=False):
        for tolerance in (1e-2, 1e-3):
            within = rows[rows["error_max"] <= tolerance].sort_values("whole_s")
            is_implicit = within["variant"] == "sparse"
            cheapest = [part.iloc[0] for part in (within[~is_implicit], within[is_implicit])
                        if len(part)]
            if len(cheapest) < 2:
                continue
            runs = [f"`{row['integrator']}`, {int(row['steps'])} steps: "
                    f"{row['first_step_s']:.2g} + {row['measured_wall_s']:.2g} s"
                    for row in cheapest]
            ratio = cheapest[0]["whole_s"] / cheapest[1]["whole_s"]
            lines.append([f"`{scene.split('/')[-1]}` {size}", f"{tolerance:.0e}", *runs,
                          f"{ratio:.2g}"])
    return ["scene", "error at most", "cheapest explicit run: start + steps",
            "cheapest implicit run: start + steps", "explicit over implicit"], lines


def run_text(row, is_named):
    """Time and evaluations an element of a run; empty without one."""
    if row is None:
        return ""
    name = f" (`{row['integrator']}`)" if is_named else ""
    evaluations = row["evaluations"] / row["elements"]
    counted = f", {evaluations:.0f} evaluations" if evaluations > 0 else ""
    return f"{1e3 * row['measured_wall_s']:.3g} ms{name}{counted}"


def exponential_table(results):
    """The cheapest run within a tolerance: of other methods, of faber and of chebyshev."""
    frame = results.table("exponential", "scene", "set", "integrator", "steps", "error_max",
                          "evaluations", "elements", "measured_wall_s", "status")
    frame = frame[frame["status"] == "ok"].copy()
    exact = ("faber", "chebyshev")
    lines = []
    for (scene, size), rows in frame.groupby(["scene", "set"], sort=False):
        overrides = str(size).split()
        words = [word for word in overrides if word.startswith("n=")]
        words += ["undamped"] * (len(overrides) > len(words))
        for tolerance in (1e-2, 1e-4, 1e-6, 1e-9):
            within = rows[rows["error_max"] <= tolerance].sort_values("measured_wall_s")
            kinds = [within[~within["integrator"].isin(exact)],
                     *(within[within["integrator"] == name] for name in exact)]
            cheapest = [part.iloc[0] if len(part) else None for part in kinds]
            others, faber = cheapest[:2]
            ratio = ("" if others is None or faber is None else
                     f"{others['measured_wall_s'] / faber['measured_wall_s']:.2g}")
            lines.append([f"`{scene.split('/')[-1]}` {', '.join(words)}", f"{tolerance:.0e}",
                          *(run_text(row, row is others) for row in cheapest), ratio])
    return ["scene", "error at most", "other methods", "`faber`", "`chebyshev`",
            "others over `faber`"], lines


TABLES = {"chain": chain_table, "continuum": continuum_table,
          "exponential": exponential_table, "first": first_table, "geometry": geometry_table,
          "goals": goals_table, "gpu": gpu_table, "implicit": implicit_table,
          "machine": machine_table, "mix": mix_table, "models": models_table,
          "networks": network_table, "portability": portability_table, "problem": problem_table,
          "schedules": schedules_table, "shapes": shapes_table, "sizes": sizes_table,
          "statics": statics_table, "verification": verification_table}
