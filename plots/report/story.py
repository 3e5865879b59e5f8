"""The chapters of the page: a question, its answer, and the charts that show it."""
import dataclasses
from collections.abc import Callable

from charts import CHARTS, own_entries

from . import summary


@dataclasses.dataclass(frozen=True)
class Chapter:
    """One question.

    charts: names in CHARTS, in order. answer: makes a sentence of Results. answered_by: charts
    whose findings answer, if there is no function.
    """
    name: str
    question: str
    charts: tuple
    answer: Callable = None
    answered_by: tuple = ()


TABLES = "tables"  # the chapter that begins with Tables 1 to 3
CHAPTERS = (
    Chapter(TABLES, "How much faster than the paper's algorithm?",
            ("paper-1", "paper-2", "paper-3", "figure-9", "speedups-1-host", "speedups-1",
             "speedups-2", "speedups-3", "sizes-3"), summary.of_speeds),
    Chapter("factors", "Where do the factors come from?",
            ("chain", "chain-block", "chain-bending", "roofline", "attribution"),
            summary.of_chains),
    Chapter("accuracy", "What does an accuracy cost?",
            ("work-precision-time", "work-precision-evaluations", "pareto", "implicit-time",
             "exponential-time", "advice", "error-budget"), summary.of_accuracy),
    Chapter("workers", "Do more cores, ranks and nodes help?",
            ("scaling-1", "scaling-2", "cluster", "cluster-nodes", "mixed-nodes", "balance"),
            answered_by=("scaling-1", "mixed-nodes")),
    Chapter("failing", "Where do methods fail?", ("atlas", "stability", "energy"),
            answered_by=("atlas", "stability")),
    Chapter("enough", "Which model is enough?", ("ladder", "ladder-errors"),
            answered_by=("ladder",)),
    Chapter("right", "Are the figures right?", ("verification", "continuum", "statics"),
            answered_by=("verification", "continuum", "statics")))
OWN = Chapter("own", "Studies of your own", ())


def entries_of(results):
    """(chapter, entries) of each chapter that the page has.

    A directory without any table that a reproduction makes has the chapter OWN alone: nothing of
    the others is missing there.
    """
    own, by_name = own_entries(results), {entry.name: entry for entry in CHARTS}
    found = []
    if not own or any(results.has(entry.table) for entry in CHARTS):
        found = [(chapter, [by_name[name] for name in chapter.charts
                            if results.expects(by_name[name].table)]) for chapter in CHAPTERS]
    return found + [(OWN, own)] * bool(own)


def answer_of(chapter, results, charts):
    """The answer of a chapter; empty if nothing of it was measured. charts: by name"""
    if chapter.answer:
        return summary.said(chapter.answer, results)
    findings = [charts[name].findings for name in chapter.answered_by if name in charts]
    return " ".join(filter(None, findings))
