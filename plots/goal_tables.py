"""The goals for bodies of any shape, and what was reached (page_tables.py).

A goal is a bar that was set before the work: on one core with AVX-512, f64, spatial, rk4, unless it
says otherwise. What was reached comes from the table `geometry` or from trials.
"""
import re
from dataclasses import dataclass

from body_tables import geometry_rates
from tables.results import NotMeasured, Results

OVER_PLATE = "a link, over the plate n = 100"
OVER_ROW = "a link, over its row in L1"
MEMORY = "memory: what a core moves in a second"
LAW = "a link of the laws `material` and `solid` has more operations; see the next line"
LARGE = ("`plate_paper` n=100", "`block` nx=64 ny=64 nz=64", "`porous` n=48", "`struts` n=63",
         "`joined_plates` n=141", "`tumbling_box` nx=40 ny=40 nz=40")
ENSEMBLES = ("`l_bracket` ensemble=64", "`two_bodies` ensemble=64", "`chain` ensemble=64 n=64")


def of_trials(*names):
    """Reads the numbers of trials."""
    def numbers(results):
        frame = Results(results.directory / "trials").table("trials", "name", "figure")
        figures = frame.set_index("name")["figure"]
        if missing := [name for name in names if name not in figures]:
            raise NotMeasured(f"trials.csv has no row {missing[0]}")
        return [float(number) for name in names
                for number in re.findall(r"\d+\.\d+", figures[name])]
    return numbers


def of_bodies(value, *names):
    """Reads a value of bodies of `geometry`."""
    def numbers(results):
        bodies = {body.name: body for body in geometry_rates(results)}
        if missing := [name for name in names if name not in bodies]:
            raise NotMeasured(f"tables/geometry.csv has no body {missing[0]}")
        found = [value(bodies[name]) for name in names]
        if None in found:
            raise NotMeasured("tables/geometry.csv lacks a cell of a goal")
        return found
    return numbers


def over(rate, base):
    """The quotient of two rows of cells, or None."""
    return (None if rate is None or base is None
            else rate["element_steps_per_s"] / base["element_steps_per_s"])


def of_plate(body):
    return body.of_plate


def of_row(body):
    return body.of_kernel


def on_two_threads(body):
    return over(body.on_cores.get("avx512"), body.on_core.get("avx512"))


def of_opencl(body):
    return over(body.on_cores.get("opencl"), body.on_cores.get("avx512"))


@dataclass
class Goal:
    """What was asked of some bodies: numbers of at least `bar`."""
    case: str
    measure: str
    bar: float | None  # None: no goal, but beside one
    reached: object    # (Results) -> list of numbers, in the order of `case`
    limit: str         # of those below the bar

    def verdict(self, reached):
        """Whether all numbers meet the bar, as they are shown."""
        met = sum(round(number, 2) >= self.bar for number in reached)
        if met == len(reached):
            return "yes"
        return f"{met} of {len(reached)}" if met else "no"


GOALS = [
    Goal("plates n = 300, 1000, 2000", OVER_PLATE, 0.92, of_trials("size_plates"), MEMORY),
    Goal("these in f32; with `velocity_verlet`; with both", OVER_PLATE, 0.75,
         of_trials("size_plates_f32", "size_plates_verlet", "size_plates_verlet_f32"), MEMORY),
    Goal("blocks 32^3, 64^3, 100^3, 200^3", OVER_PLATE, 0.8, of_trials("size_blocks"), MEMORY),
    Goal("these in f32; with `velocity_verlet`; with both", OVER_PLATE, 0.75,
         of_trials("size_blocks_f32", "size_blocks_verlet", "size_blocks_verlet_f32"), MEMORY),
    Goal("a porous body, 60 % filled, n = 48", OVER_PLATE, 0.5, of_bodies(of_plate, LARGE[2]),
         "links of neighbours that lie in another lane; few links an element"),
    Goal("two plates with links between them", OVER_PLATE, 0.85, of_bodies(of_plate, LARGE[4]),
         "the extra links, which are computed one by one"),
    Goal("`l_bracket`, 152 elements", OVER_PLATE, 0.45, of_bodies(of_plate, "`l_bracket`"), LAW),
    Goal("the same", OVER_ROW, None, of_bodies(of_row, "`l_bracket`"),
         "few packs: each pass over the body begins and ends soon"),
    Goal("ensembles of 64: `l_bracket`, `two_bodies`, `chain`", OVER_PLATE, 0.85,
         of_bodies(of_plate, *ENSEMBLES), LAW),
    Goal("the same", OVER_ROW, None, of_bodies(of_row, *ENSEMBLES),
         "extra links of `two_bodies`, which are computed one by one"),
    Goal("`tumbling_box` 40^3", OVER_ROW, 0.85, of_bodies(of_row, LARGE[5]), MEMORY),
    Goal("all bodies of 10,000 elements and more, in the README's order",
         "2 threads over 1", 1.9, of_bodies(on_two_threads, *LARGE),
         "a machine that is shared; borders between blocks of rows"),
    Goal("block 64^3 on PoCL, all cores", "over `avx512`", 0.85, of_bodies(of_opencl, LARGE[1]),
         ""),
]


def goals_table(results):
    """Each goal, what was reached, and what limits the rest."""
    lines = []
    for goal in GOALS:
        reached = goal.reached(results)
        numbers = ", ".join(f"{number:.2f}" for number in reached)
        bar, verdict = (("", "") if goal.bar is None
                        else (f"{goal.bar:.2f}", goal.verdict(reached)))
        lines.append([goal.case, goal.measure, bar, numbers, verdict,
                      "" if verdict == "yes" else goal.limit])
    return ["bodies", "rate of", "goal", "reached", "met", "what limits it"], lines
