"""Published problems: how far extrapolated figures are from the published ones."""
from description import Axis, Chart, Filter, Look, Panel, Series, guide, keys_of
from tables.results import NotMeasured

COLUMNS = {
    "problem": "problem", "figure": "figure", "unit": "unit", "reference": "published",
    "extrapolated": "extrapolated", "extrapolated_uncertainty": "uncertain by", "order": "order",
    "grid_error": "grid", "model_error": "model", "time_error": "time", "status": "status",
    "reason": "reason", "source": "source"}
KINDS = {"model_error": ("extrapolated", Look("#0072B2", "circle", size=8)),
         "grid_error": ("finest grid", Look("#E69F00", "diamond", is_hollow=True, size=8))}


def verification(results):
    """The error of the extrapolated figure, with its uncertainty, and that of the finest grid."""
    frame = results.table("verification", "problem", "figure", "reference", "extrapolated",
                          "extrapolated_uncertainty", "grid_error", "model_error", "tolerance",
                          "status", optional=["unit", "order", "time_error", "reason", "source"])
    held = frame[frame["model_error"].notna()].copy()
    if held.empty:
        raise NotMeasured("no figure has a reference")
    held["place"] = held["problem"].str.replace("_", " ") + ", " + held["figure"]
    share = (held["extrapolated_uncertainty"] / held["reference"]).abs()
    limit = 100 * held["model_error"]
    held = held.assign(of_limit=limit, of_finest=limit + 100 * held["grid_error"],
                       low=limit - 100 * share, high=limit + 100 * share)
    series = [
        Series("finest grid", held, "of_finest", "place", KINDS["grid_error"][1],
               keys_of(held, "status")),
        Series("extrapolated", held, "of_limit", "place", KINDS["model_error"][1],
               keys_of(held, "status"), low="low", high="high", interval_of="x")]
    places = list(held["place"])[::-1]
    zero = guide("as published", [(0, places[0]), (0, places[-1])], Look("ink", line="dash"))
    agree = int((frame["status"] == "agrees").sum())
    largest = held["model_error"].abs().max()
    heading = ("Published problems: relative difference of the extrapolated figure to the "
               "published one, with its uncertainty, and of the finest grid.")
    words = (f"{agree} of {len(held)} figures agree with the published ones; the largest "
             f"difference is {100 * largest:.2g} %.")
    panel = Panel(Axis("difference to the published figure [%]"),
                  Axis("", "category", categories=places), series + [zero])
    return Chart("verification", frame, COLUMNS, [panel], heading, words,
                 [Filter("status", "Status")], size=(7.5, 6), height=620)
