"""Tables of bodies of many shapes that pages quote (page_tables.py)."""
import json
from dataclasses import dataclass

from tables.results import ROOT, is_pair
from tables.words import speedup_over


def bodies_of(results, *needed, optional=()):
    """Yields (name, scene, rows) of each body of `geometry` on one rank, in its order."""
    frame = results.table("geometry", "scene", "set", "variant", "threads", "ranks", "label",
                          *needed, optional=optional)
    frame = frame[~is_pair(frame) & (frame["ranks"] == 1)].copy()
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
    """Whose links the first body of a shipped scene has: those of `paper` or of `material`."""
    path = ROOT / "experiments" / "scenes" / f"{scene}.json"
    law = json.loads(path.read_text())["bodies"][0]["constants"]["law"]
    return "material" if law == "solid" else law


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


@dataclass
class BodyRates:
    """A body of `geometry`. Rates are rows of cells, by variant; None if one has no row."""
    name: str
    elements: int
    links_an_element: float
    on_core: dict   # on one core
    on_cores: dict  # on all cores
    of_plate: float | None = None   # rate of a link, avx512, one core: over the plate n = 100
    of_kernel: float | None = None  # the same over the law's row kernel in the L1 cache


def geometry_rates(results):
    """The bodies of many shapes, in their order."""
    speedups = [f"{form}speedup_vs_scalar{end}" for form in ("", "extrapolated_")
                for end in ("", "_low", "_high")]
    in_l1, bodies = row_kernels(results), []
    for name, scene, rows in bodies_of(results, "elements", "links", "element_steps_per_s",
                                       "link_steps_per_s", "status", optional=speedups):
        first, ok = rows.iloc[0], rows[rows["status"] == "ok"]
        on = {is_team: {variant: found.iloc[0] for variant, found in
                        ok[(ok["threads"] > 1) == is_team].groupby("variant")}
              for is_team in (False, True)}
        bodies.append(BodyRates(name, int(first["elements"]), first["links"] / first["elements"],
                                on[False], on[True]))
        if "avx512" in on[False]:
            bodies[-1].of_kernel = (
                1e-9 * in_l1[law_of(scene)] * on[False]["avx512"]["link_steps_per_s"])
    plate = next((body.on_core.get("avx512") for body in bodies
                  if body.name == "`plate_paper` n=100"), None)
    for body in bodies:
        if plate is not None and "avx512" in body.on_core:
            body.of_plate = (body.on_core["avx512"]["link_steps_per_s"]
                             / plate["link_steps_per_s"])
    return bodies


def shapes_table(results):
    """What SIMD gains on bodies of many shapes, on one core: the front page's part of
    geometry_table."""
    lines = [[body.name, f"{body.elements}", f"{body.links_an_element:.2f}",
              f"{1e-6 * body.on_core['avx512']['element_steps_per_s']:.3g}",
              speedup_over(body.on_core["avx512"], "scalar")]
             for body in geometry_rates(results) if "avx512" in body.on_core]
    return ["body", "elements", "links an element", "`avx512`", "over `scalar`"], lines


def geometry_table(results):
    """Rates of the bodies of many shapes; those of a link over those of the plate n = 100 and of
    the law's row kernel in the L1 cache."""
    rates = ["scalar", "avx2", "avx512"]

    def rate(rows, variant):
        return f"{1e-6 * rows[variant]['element_steps_per_s']:.3g}" if variant in rows else ""

    def share(value):
        return "" if value is None else f"{value:.2f}"

    lines = [[body.name, f"{body.elements}", f"{body.links_an_element:.2f}",
              *(rate(body.on_core, variant) for variant in rates),
              rate(body.on_cores, "avx512"), rate(body.on_cores, "opencl"),
              share(body.of_plate), share(body.of_kernel),
              speedup_over(body.on_core["avx512"], "scalar") if "avx512" in body.on_core else ""]
             for body in geometry_rates(results)]
    return ["body", "elements", "links an element", *(f"`{name}`" for name in rates),
            "`avx512`, all cores", "`opencl`, all cores", "per link, over the plate n = 100",
            "per link, over its row in L1", "`avx512` over `scalar`"], lines
