"""Tables of bodies of many shapes that pages quote (page_tables.py)."""
import json

from tables.results import ROOT
from tables.words import speedup_over


def bodies_of(results, *needed, optional=()):
    """Yields (name, scene, rows) of each body of `geometry` on one rank, in its order."""
    frame = results.table("geometry", "scene", "set", "variant", "threads", "ranks", "label",
                          *needed, optional=optional)
    frame = frame[~frame["label"].str.contains("A/A") & (frame["ranks"] == 1)].copy()
    frame["set"] = frame["set"].fillna("")
    for (scene, values), rows in frame.groupby(["scene", "set"], sort=False):
        yield f"`{scene.split('/')[-1]}` {values}".strip(), scene, rows


def row_kernels(results):
    """Time of a link in steps of rk4 [ns], by law: avx512, one core, rows of a plate (two links an
    element) whose operands are in the L1 cache."""
    frame = results.table("kernels", "kernel", "level", "variant", "model", "precision", "threads",
                          "measured_ns_per_element")
    frame = frame[(frame["level"] == "L1") & (frame["variant"] == "avx512")
                  & (frame["model"] == "spatial") & (frame["precision"] == "f64")
                  & (frame["threads"] == 1)].set_index("kernel")["measured_ns_per_element"]
    return {law: (3 * frame[row] + frame[f"{row}_last"]) / 2
            for law, row in (("paper", "stage_row"), ("material", "stage_row_material"))}


def law_of(scene):
    """The law of the first body of a shipped scene."""
    path = ROOT / "experiments" / "scenes" / f"{scene}.json"
    return json.loads(path.read_text())["bodies"][0]["constants"]["law"]


def schedules_table(results):
    """What the records of `geometry` say of the order of rows: avx512 on one core, and OpenCL."""
    lines = []
    for name, _, rows in bodies_of(results, "schedule"):
        on_core = rows[(rows["variant"] == "avx512") & (rows["threads"] == 1)]["schedule"]
        # A record of OpenCL begins with the device, its bands of rows and lanes.
        on_device = rows[rows["variant"] == "opencl"]["schedule"].str.split("; ").str[-1]
        lines.append([name, *(found.iloc[0] if len(found) else ""
                              for found in (on_core, on_device))])
    return ["body", "`avx512`, one core", "`opencl`"], lines


def geometry_table(results):
    """Rates of the bodies of many shapes; those of a link over those of the plate n = 100 and of
    the law's row kernel in the L1 cache."""
    speedups = [f"{form}speedup_vs_scalar{end}" for form in ("", "extrapolated_")
                for end in ("", "_low", "_high")]
    bodies = list(bodies_of(results, "elements", "links", "element_steps_per_s",
                            "link_steps_per_s", "status", optional=speedups))
    rates, in_l1 = ["scalar", "avx2", "avx512"], row_kernels(results)

    def row_of(rows, variant, is_on_all_cores=False):
        rows = rows[(rows["variant"] == variant) & (rows["status"] == "ok")
                    & ((rows["threads"] > 1) == is_on_all_cores)]
        return None if rows.empty else rows.iloc[0]

    def rate(row):
        return "" if row is None else f"{1e-6 * row['element_steps_per_s']:.3g}"

    plate = next((row_of(rows, "avx512") for name, _, rows in bodies
                  if name == "`plate_paper` n=100"), None)
    lines = []
    for name, scene, rows in bodies:
        fastest, cores = row_of(rows, "avx512"), row_of(rows, "avx512", True)
        per_link = "" if fastest is None or plate is None else (
            f"{fastest['link_steps_per_s'] / plate['link_steps_per_s']:.2f}")
        of_kernel = "" if fastest is None else (
            f"{1e-9 * in_l1[law_of(scene)] * fastest['link_steps_per_s']:.2f}")
        first = rows.iloc[0]
        lines.append([name, f"{int(first['elements'])}",
                      f"{first['links'] / first['elements']:.2f}",
                      *(rate(row_of(rows, variant)) for variant in rates), rate(cores),
                      rate(row_of(rows, "opencl", True)), per_link, of_kernel,
                      "" if fastest is None else speedup_over(fastest, "scalar")])
    return ["body", "elements", "links an element", *(f"`{name}`" for name in rates),
            "`avx512`, all cores", "`opencl`, all cores", "per link, over the plate n = 100",
            "per link, over its row in L1", "`avx512` over `scalar`"], lines
