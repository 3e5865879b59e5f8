"""All charts, in the order of the page.

A chart is a function that takes Results and returns a Chart, and one line in CHARTS.
"""
import dataclasses
from collections.abc import Callable

from . import (advice, balance, cells, chain, cluster, continuum, error_budget, failures, kernels,
               ladder, mixed_nodes, paper, stability, statics, sweep, verification,
               work_precision)


@dataclasses.dataclass(frozen=True)
class Entry:
    """One chart of the page.

    name: the id of its section. make: the function. figure: the name of its PNG, which several
    charts may share.
    """
    name: str
    title: str
    table: str
    make: Callable
    figure: str


CHARTS = [Entry(*words) for words in (
    ("paper-1", "The paper's Table 1", "paper_table1", paper.paper_table("paper_table1"),
     "paper_table1"),
    ("paper-2", "The paper's Table 2", "paper_table2", paper.paper_table("paper_table2"),
     "paper_table2"),
    ("paper-3", "The paper's Table 3", "paper_table3", paper.paper_table("paper_table3"),
     "paper_table3"),
    ("figure-9", "The paper's figure 9", "paper_figure9", paper.figure9, "paper_figure9"),
    ("speedups-1-host", "Speed-ups, Table 1 on one process", "table1_host",
     cells.speedups("table1_host"), "table1_host"),
    ("speedups-1", "Speed-ups, Table 1", "table1", cells.speedups("table1"), "table1"),
    ("speedups-2", "Speed-ups, Table 2", "table2", cells.speedups("table2"), "table2"),
    ("speedups-3", "Speed-ups, Table 3", "table3", cells.speedups("table3"), "table3"),
    ("sizes-3", "Time over the size of the plate", "table3", cells.figure9("table3"),
     "table3_figure9"),
    ("work-precision-time", "Error against time", "work_precision",
     work_precision.against_time("work_precision"), "work_precision"),
    ("work-precision-evaluations", "Error against force evaluations", "work_precision",
     work_precision.against_evaluations("work_precision"), "work_precision"),
    ("implicit-time", "Implicit methods: error against time", "implicit",
     work_precision.against_time("implicit"), "implicit"),
    ("exponential-time", "Exponential methods: error against time", "exponential",
     work_precision.against_time("exponential"), "exponential"),
    ("pareto", "Pareto front", "work_precision", work_precision.pareto, "pareto"),
    ("chain", "Chain of factors", "chain", chain.chain("chain"), "chain"),
    ("chain-block", "The same chain on a thick body", "chain_block", chain.chain("chain_block"),
     "chain_block"),
    ("chain-bending", "The same chain on a strongly bent plate", "chain_bending",
     chain.chain("chain_bending"), "chain_bending"),
    ("roofline", "Roofline", "kernels", kernels.roofline, "roofline"),
    ("attribution", "Where the time of a step goes", "attribution", kernels.attribution,
     "attribution"),
    ("scaling-1", "Scaling over ranks, Table 1", "table1", cells.scaling("table1"),
     "table1_scaling"),
    ("scaling-2", "Scaling over ranks, Table 2", "table2", cells.scaling("table2"),
     "table2_scaling"),
    ("cluster", "A simulated cluster", "cluster_simulated", cluster.cluster, "cluster_simulated"),
    ("cluster-nodes", "A simulated cluster, by its nodes", "cluster_simulated", cluster.by_nodes,
     "cluster_simulated_nodes"),
    ("mixed-nodes", "Clusters of fast and slow nodes", "mixed_nodes", mixed_nodes.mixed_nodes,
     "mixed_nodes"),
    ("balance", "Balance of two executors", "balance", balance.balance, "balance"),
    ("stability", "Stability map", "stability", stability.stability, "stability_map"),
    ("energy", "Stable is not accurate", "stability_energy", stability.energy, "stability_energy"),
    ("ladder", "Model ladder", "model_ladder", ladder.verdicts, "model_ladder_verdicts"),
    ("ladder-errors", "Model ladder: error against time", "model_ladder", ladder.errors,
     "model_ladder"),
    ("atlas", "Failure atlas", "failures", failures.atlas, "failures"),
    ("advice", "Advice", "advise", advice.advice, "advise"),
    ("error-budget", "Error budget", "error_budget", error_budget.error_budget, "error_budget"),
    ("continuum", "Lattices and continuum theory", "continuum", continuum.continuum, "continuum"),
    ("verification", "Published problems", "verification", verification.verification,
     "verification"),
    ("statics", "States of rest", "statics", statics.statics, "statics"),
)]
# Tables that are drawn in a chart of another table, or have no chart.
BESIDE = ["geometry", "bodies", "verification_grids", "table3_gpu", "stability_map", "ceilings",
          "table1_simulated", "table2_simulated", "mixed_nodes_held", "work_precision_cheapest",
          "work_precision_comparisons"]
# The charts of any other table, which is a study of cells that a user wrote.
CELLS = {"": ("speed-ups", cells.speedups), "_rates": ("rates", sweep.rates),
         "_scaling": ("scaling over ranks", cells.scaling),
         "_figure9": ("time over the size", cells.figure9),
         "_errors": ("error against time", work_precision.against_time)}


DERIVED = "_simulated", "_cheapest", "_comparisons"  # tables beside that of a study


def figures_of(results):
    """The entries of each figure, by its name, for the tables that are there."""
    found = {}
    for entry in CHARTS:
        if results.has(entry.table):
            found.setdefault(entry.figure, []).append(entry)
    return {**found, **{entry.figure: [entry] for entry in own_entries(results)}}


def own_entries(results):
    """The entries of tables of a user's own studies; "own-" keeps their ids apart from others."""
    known = {entry.table for entry in CHARTS} | set(BESIDE)
    return [Entry(f"own-{table}{ending}", f"{table}: {words}", table, make(table),
                  f"{table}{ending}")
            for table in results.names()
            if table not in known and not table.endswith(DERIVED)
            for ending, (words, make) in CELLS.items()]
