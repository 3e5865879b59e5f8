"""The summary: three figures with a sentence each, from the tables."""
import dataclasses

from charts.chain import best_stage
from tables.results import FAULTS, NotMeasured
from tables.words import problem, shown, speedup_over, with_interval

BASES = {"as_published": "the paper's algorithm in plain code (`as_published`)",
         "reference": "plain code with quaternions (`reference`)",
         "scalar": "the same kernels without vectors (`scalar`)"}
CHAINS = {"chain": "the paper's plate", "chain_block": "a thick body",
          "chain_bending": "a strongly bent plate"}


@dataclasses.dataclass(frozen=True)
class Card:
    """A figure, what it counts, and of what it is."""
    number: str
    words: str
    rest: str

    @property
    def text(self):
        """All of it as text."""
        return f"{self.number} {self.words}. {self.rest}".strip()


def not_measured(what, study):
    """The card of what is missing."""
    return Card("–", f"{what} not measured", f"Run `dssbench experiment {study}`.")


def of_speed(results):
    """The fastest configuration of Table 1, against every base."""
    try:
        frame = results.table("table1", "source", "label", "scene", "set", "steps", "status",
                              "check", optional=[f"{form}speedup_vs_{base}{end}"
                                                 for form in ("", "extrapolated_") for base in BASES
                                                 for end in ("", "_low", "_high")])
    except NotMeasured:
        return not_measured("speed-ups were", "table1")
    frame = frame[(frame["source"] == "measured") & (frame["status"] == "ok")]
    against = frame["speedup_vs_scalar"].fillna(frame["extrapolated_speedup_vs_scalar"])
    if against.dropna().empty:
        return Card("–", "no speed-up", "No cell of tables/table1.csv has one.")
    best = frame.loc[against.idxmax()]
    factors = [(words, speedup_over(best, base)) for base, words in BASES.items()
               if speedup_over(best, base)]
    (first, factor), *others = factors
    more = "".join(f"; over {words} {value}" for words, value in others)
    passed = (frame["check"] == "passed").sum()
    return Card(f"{factor} times", f"as fast as {first}",
                f"The same arithmetic in {best['label']} over one thread, for each step of "
                f"{problem(best['scene'], best['set'])}{more}. {passed} of {len(frame)} cells of "
                "Table 1 passed the check against the oracle.")


def of_speeds(results):
    """The same as a sentence; empty if nothing was measured."""
    return of_speed(results).text if results.has("table1") else ""


def chain_of(results, table):
    """The fastest stage of a chain within the allowed error, or none."""
    return best_stage(results.table(table, "stage", "role", "label", "base", "status", optional=[
        "factor_vs_base", "factor_vs_base_low", "factor_vs_base_high", "error_max", "error_bar"]))


def factor_of(stage):
    """The factor of a stage with its interval."""
    return with_interval(*(stage[f"factor_vs_base{end}"] for end in ("", "_low", "_high")))


def of_chain(results):
    """The fastest stage of the chain within the allowed error."""
    try:
        best = chain_of(results, "chain")
    except NotMeasured:
        return not_measured("the chain of factors was", "chain")
    if best is None:
        return Card("–", "no stage", "No stage of the chain keeps the allowed error.")
    rest = (f"Model, method and precision chosen, up to the stage: {best['label']}. The error is "
            f"{shown(best['error_max'])}; {shown(best['error_bar'])} is allowed")
    return Card(f"{factor_of(best)} times", f"as fast as {BASES.get(best['base'], best['base'])}",
                rest + grid_error(results) + ".")


def grid_error(results):
    """The error that the grid of the compared plate has itself."""
    try:
        error = first_comparison(results)["space_error"]
    except (NotMeasured, LookupError):
        return ""
    return f", and the grid itself has {shown(error, 2)}" if shown(error) else ""


def of_chains(results):
    """The factors of all chains, and the stages that they end at."""
    parts = []
    for table, body in CHAINS.items():
        try:
            best = chain_of(results, table)
        except NotMeasured:
            continue
        if best is not None:
            parts.append(f"{factor_of(best)} on {body} (last stage: {best['label']})")
    if not parts:
        return ""
    return f"Times as fast as the paper's algorithm, at its accuracy: {'; '.join(parts)}."


def first_comparison(results):
    """The first comparison of a method with the paper's that has a value."""
    pairs = results.table("work_precision_comparisons", "scene", "base", "contender",
                          "contender_error_max", optional=["times_cheaper", "space_error",
                                                           "times_cheaper_than_best_base"])
    return pairs.dropna(subset=["times_cheaper"]).iloc[0]


def of_cheapest(results):
    """The first comparison of a method with the paper's."""
    row = first_comparison(results)
    fair = shown(row["times_cheaper_than_best_base"])
    if fair:
        fair = (f" ({fair} times cheaper than {row['base'].split()[0]} at the step that this "
                "accuracy needs)")
    return (f"on {row['scene']}, {row['contender']} is {shown(row['times_cheaper'])} times cheaper "
            f"than the paper's {row['base']}{fair} at an error of "
            f"{shown(row['contender_error_max'], 2)}, where the error of the grid is "
            f"{shown(row['space_error'], 2)}")


def of_advice(results):
    """How many tolerances the advice keeps, and at what cost."""
    advice = results.table("advise", "tolerance", "true_error", optional=["time_over_cheapest"])
    kept = (advice["true_error"] <= advice["tolerance"]).sum()
    most = shown(advice["time_over_cheapest"].max())
    over = f" at no more than {most} times the cheapest time of a full search" if most else ""
    return f"`dssbench advise` keeps {kept} of {len(advice)} tolerances{over}"


def of_accuracy(results):
    """The cost of an accuracy; empty if it was not measured."""
    parts = []
    for part in (of_cheapest, of_advice):
        try:
            parts.append(part(results))
        except (NotMeasured, IndexError):
            pass
    sentence = "; ".join(parts)
    return sentence and f"{sentence[0].upper()}{sentence[1:]}."


def counted(count, one, several):
    """A number with the words that fit it: `one` after 1, else `several`."""
    return f"{count} {one if count == 1 else several}"


def of_age(ages):
    """How many records are old, and how many tables have none."""
    old, unknown = len(ages.old()), len(ages.unknown())
    words = "no record is known to be old"
    if old:
        verb = "are" if old != 1 else "is"
        words = f"{old} of {len(ages.records)} records {verb} old, wholly or in part"
    if unknown:
        words += ", and " + counted(unknown, "table has no record, so that its age is unknown",
                                    "tables have no record, so that their age is unknown")
    return words


def comparisons(results):
    """(held, all, words) of what was compared with theory, by table."""
    for table, words in (("failures", "cells of the failure atlas"),
                         ("model_ladder", "rows of the model ladder"),
                         ("stability", "step limits")):
        try:
            status = results.table(table, "status")["status"]
        except NotMeasured:
            continue
        yield status.isin(["ok", "passed", "bound"]).sum(), len(status), words


def of_trust(results, missing, ages):
    """What agrees with theory, what is missing and what is old."""
    faults = sum(lack.is_fault for lack in missing)
    count = len(missing) - faults
    lack = "nothing is missing"
    if count:
        lack = counted(count, "section is not measured", "sections are not measured")
    if faults:
        lack += ", " + counted(faults, "section cannot be drawn", "sections cannot be drawn")
    state = f"In this report {lack}, and {of_age(ages)}."
    found = list(comparisons(results))
    if not found:
        return Card("–", "nothing was compared with theory", state)
    held, count = (sum(numbers) for numbers in list(zip(*found))[:2])
    parts = ", ".join(f"{held} of {count} {words}" for held, count, words in found)
    return Card(f"{shown(held)} of {shown(count)}", "predictions of theory hold",
                f"{parts} are as theory says or on the safe side. {state}")


def said(make, *of):
    """What `make` makes; if its tables have values of an unexpected kind, it says so."""
    try:
        return make(*of)
    except FAULTS as fault:
        return f"This sentence cannot be made of its tables: {type(fault).__name__}: {fault}."


def cards(results, missing, ages):
    """All cards, in order."""
    made = (said(of_speed, results), said(of_chain, results),
            said(of_trust, results, missing, ages))
    return [card if isinstance(card, Card) else Card("–", "no figure", card) for card in made]
