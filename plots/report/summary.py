"""Three sentences on the whole, with figures from the tables."""
from charts.chain import best_link
from tables.results import FAULTS, NotMeasured
from tables.words import shown, with_interval


def of_speed(results):
    """What the fastest variant does, against the straightforward code."""
    exact, scaled = "speedup_vs_reference", "extrapolated_speedup_vs_reference"
    try:
        frame = results.table("table1_host", "source", "label", "scene", "set", "steps", "measured_wall_s", "status", "check", "speedup_vs_scalar", exact, scaled)
    except NotMeasured:
        return "How fast the variants are was not measured (`dssbench experiment table1_host`)."
    frame = frame[(frame["source"] == "measured") & (frame["status"] == "ok")]
    against = frame[exact].fillna(frame[scaled])
    if against.dropna().empty:
        return "No cell of tables/table1_host.csv has a speed-up."
    best = frame.loc[against.idxmax()]

    def interval(column):
        return with_interval(best[column], best.get(f"{column}_low"), best.get(f"{column}_high"))

    what = f"{best['label']}, computes {shown(best['steps'])} steps of {best['scene']} {best['set']} in {shown(best['measured_wall_s'])} s"
    return (f"The fastest configuration of Table 1 on this machine, {what}: {interval(exact) or interval(scaled)} times as fast as the straightforward `reference`{'' if interval(exact) else ' (scaled from fewer steps)'} and "
            f"{interval('speedup_vs_scalar')} times as fast as `scalar`, one thread each, with {(frame['check'] == 'passed').sum()} of {len(frame)} cells checked against the oracle.")


def of_accuracy(results):
    """What an accuracy costs."""
    parts = []
    try:
        best = best_link(results.table("chain", "label", "factor_vs_reference", "error_max", "error_bar", "status"))
        parts.append("no link of the chain keeps the allowed error" if best is None else
                     f"the chain from the reference to the cheapest run within an error of {shown(best['error_bar'])} reaches {shown(best['factor_vs_reference'])} times ({best['label']}) "
                     f"with an error of {shown(best['error_max'])}")
    except NotMeasured:
        pass
    try:
        pair = results.table("work_precision_comparisons", "scene", "base", "contender", "times_cheaper", "contender_error_max", "space_error").dropna(subset=["times_cheaper"])
        if len(pair):
            row = pair.iloc[0]
            best = row.get("times_cheaper_than_best_base")
            fair = f" ({shown(best)} times than {row['base'].split()[0]} at the step that this accuracy needs)" if best == best and best else ""
            parts.append(f"on {row['scene']} {row['contender']} is {shown(row['times_cheaper'])} times cheaper than the paper's {row['base']}{fair} at an error of "
                         f"{shown(row['contender_error_max'], 2)}, where the grid's own is {shown(row['space_error'], 2)}")
    except NotMeasured:
        pass
    try:
        advice = results.table("advise", "tolerance", "true_error", "time_over_cheapest")
        most = shown(advice["time_over_cheapest"].max())
        kept = (advice["true_error"] <= advice["tolerance"]).sum()
        parts.append(f"`dssbench advise` keeps {kept} of {len(advice)} tolerances" + (f" at no more than {most} times the cheapest that a full search finds" if most else ""))
    except NotMeasured:
        pass
    if not parts:
        return "What an accuracy costs was not measured (`dssbench experiment work_precision`)."
    sentence = "; ".join(parts)
    return sentence[0].upper() + sentence[1:] + "."


def of_age(ages):
    """How many records are old, and how many tables have none."""
    old, count, unknown = len(ages.old()), len(ages.records), len(ages.unknown())
    words = f"{old} of {count} records {'are' if old != 1 else 'is'} old, wholly or in part" if old else "no record is known to be old"
    return words + (f", while {unknown} table{'s have' if unknown != 1 else ' has'} no record, so that {'their' if unknown != 1 else 'its'} age is unknown" if unknown else "")


def of_trust(results, missing, ages):
    """What holds, what is missing and what is old."""
    parts = []
    for table, words in (("failures", "cells of the failure atlas are as theory says"), ("model_ladder", "rows of the model ladder are as expected"),
                         ("stability", "step limits agree with theory or are on the safe side")):
        try:
            status = results.table(table, "status")["status"]
            parts.append(f"{status.isin(['ok', 'passed', 'bound']).sum()} of {len(status)} {words}")
        except NotMeasured:
            pass
    held = ", ".join(parts) if parts else "nothing was held against theory"
    faults = sum(lack.is_fault for lack in missing)
    count = len(missing) - faults
    lack = f"{count} section{'s are' if count != 1 else ' is'} not measured" if count else "nothing is missing"
    lack += f", {faults} section{'s' if faults != 1 else ''} cannot be drawn" if faults else ""
    return f"{held[0].upper()}{held[1:]}; in this report {lack}, and {of_age(ages)}."


def said(make, *of):
    """A sentence; one on tables with values of an unexpected kind says that."""
    try:
        return make(*of)
    except FAULTS as fault:
        return f"This sentence cannot be made of its tables: {type(fault).__name__}: {fault}."


def sentences(results, missing, ages):
    return [said(of_speed, results), said(of_accuracy, results), said(of_trust, results, missing, ages)]
