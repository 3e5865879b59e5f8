"""The charts of the report, in its order. A new one is a module with a function that takes Results and gives a Chart, and a line here."""
from .advice import advice
from .atlas import atlas
from .attribution import attribution
from .chain import chain
from .cluster import cluster
from .continuum import continuum
from .energy import energy
from .error_budget import error_budget
from .ladder import ladder_errors, ladder_verdicts
from .roofline import roofline
from .scaling import scaling
from .stability import stability
from .statics import statics
from .work_precision import against_evaluations, against_time, pareto

# What a chart is called and which table it is of stand here, so that one that was not measured can be named.
CHARTS = [
    ("work-precision-time", "Error against time", "work_precision", against_time),
    ("work-precision-evaluations", "Error against force evaluations", "work_precision", against_evaluations),
    ("pareto", "Pareto front", "work_precision", pareto),
    ("chain", "Chain of factors", "chain", chain),
    ("roofline", "Roofline", "kernels", roofline),
    ("attribution", "Where the time of a step goes", "attribution", attribution),
    ("scaling-1", "Scaling over ranks, Table 1", "table1", scaling("table1")),
    ("scaling-2", "Scaling over ranks, Table 2", "table2", scaling("table2")),
    ("cluster", "A simulated cluster", "cluster_simulated", cluster),
    ("stability", "Stability map", "stability", stability),
    ("energy", "Stable is not accurate", "stability_energy", energy),
    ("ladder", "Model ladder", "model_ladder", ladder_verdicts),
    ("ladder-errors", "Model ladder: error against time", "model_ladder", ladder_errors),
    ("atlas", "Failure atlas", "failures", atlas),
    ("advice", "Advice", "advise", advice),
    ("error-budget", "Error budget", "error_budget", error_budget),
    ("continuum", "Lattices and continuum theory", "continuum", continuum),
    ("statics", "States of rest", "statics", statics),
]
