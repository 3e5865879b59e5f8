"""The summary: three sentences with values from the tables."""
from charts.chain import best_stage
from tables.results import FAULTS, NotMeasured
from tables.words import shown, speedup_over


BASES = {"as_published": "the paper's algorithm in plain code (`as_published`)",
         "reference": "plain code with quaternions (`reference`)",
         "scalar": "the same kernels without vectors (`scalar`)"}


def of_speed(results):
    """The fastest configuration of Table 1, against every base."""
    try:
        frame = results.table("table1", "source", "label", "scene", "set", "steps", "status",
                              "check", optional=[f"{form}speedup_vs_{base}{end}"
                                                 for form in ("", "extrapolated_") for base in BASES
                                                 for end in ("", "_low", "_high")])
    except NotMeasured:
        return "The variants were not timed (`dssbench experiment table1`)."
    frame = frame[(frame["source"] == "measured") & (frame["status"] == "ok")]
    against = frame["speedup_vs_scalar"].fillna(frame["extrapolated_speedup_vs_scalar"])
    if against.dropna().empty:
        return "No cell of tables/table1.csv has a speed-up."
    best = frame.loc[against.idxmax()]

    factors = [f"{speedup_over(best, base)} times as fast as {words}"
               for base, words in BASES.items() if speedup_over(best, base)]
    passed = (frame["check"] == "passed").sum()
    return (f"The fastest configuration of Table 1 on this machine is {best['label']} "
            f"({best['scene']} {best['set']}): {', '.join(factors)}, each on one thread, per step; "
            f"{passed} of {len(frame)} cells passed the check against the oracle.")


def of_chain(results):
    """The fastest stage of the chain within the allowed error."""
    best = best_stage(results.table("chain", "stage", "role", "label", "base", "status", optional=[
        "factor_vs_base", "error_max", "error_bar"]))
    if best is None:
        return "no stage of the chain keeps the allowed error"
    return (f"the fastest stage of the chain within an error of {shown(best['error_bar'])} is "
            f"{shown(best['factor_vs_base'])} times as fast as {best['base']} "
            f"({best['label']}), with an error of {shown(best['error_max'])}")


def of_cheapest(results):
    """The first comparison of a method with the paper's; empty if there is none."""
    pairs = results.table("work_precision_comparisons", "scene", "base", "contender",
                          "contender_error_max", optional=["times_cheaper", "space_error",
                                                           "times_cheaper_than_best_base"])
    pairs = pairs.dropna(subset=["times_cheaper"])
    if pairs.empty:
        return ""
    row = pairs.iloc[0]
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
    """The cost of an accuracy."""
    parts = []
    for part in (of_chain, of_cheapest, of_advice):
        try:
            parts.append(part(results))
        except NotMeasured:
            pass
    sentence = "; ".join(filter(None, parts))
    if not sentence:
        return "The cost of an accuracy was not measured (`dssbench experiment work_precision`)."
    return sentence[0].upper() + sentence[1:] + "."


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


def of_trust(results, missing, ages):
    """What agrees with theory, what is missing and what is old."""
    parts = []
    for table, words in (
            ("failures", "cells of the failure atlas are as theory says"),
            ("model_ladder", "rows of the model ladder are as expected"),
            ("stability", "step limits agree with theory or are on the safe side")):
        try:
            status = results.table(table, "status")["status"]
        except NotMeasured:
            continue
        held = status.isin(["ok", "passed", "bound"]).sum()
        parts.append(f"{held} of {len(status)} {words}")
    checked = ", ".join(parts) or "nothing was compared with theory"
    faults = sum(lack.is_fault for lack in missing)
    count = len(missing) - faults
    lack = "nothing is missing"
    if count:
        lack = counted(count, "section is not measured", "sections are not measured")
    if faults:
        lack += ", " + counted(faults, "section cannot be drawn", "sections cannot be drawn")
    return (f"{checked[0].upper()}{checked[1:]}; in this report {lack}, and {of_age(ages)}.")


def said(make, *of):
    """A sentence; if its tables have values of an unexpected kind, it says so."""
    try:
        return make(*of)
    except FAULTS as fault:
        return f"This sentence cannot be made of its tables: {type(fault).__name__}: {fault}."


def sentences(results, missing, ages):
    """All sentences, in order."""
    return [said(of_speed, results), said(of_accuracy, results),
            said(of_trust, results, missing, ages)]
