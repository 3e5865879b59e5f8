"""Results as tables of pandas, with units."""
import functools
import json
import os
import pathlib
import re
import subprocess
from typing import Any, Callable

import pandas as pd

from . import _core

UNITS_OF_STATES = {"x": "m", "y": "m", "z": "m", "ux": "m", "uy": "m", "uz": "m", "vx": "m/s",
                   "vy": "m/s", "vz": "m/s", "wx": "rad/s", "wy": "rad/s", "wz": "rad/s",
                   "stress_vm": "Pa"}
UNITS_OF_HISTORIES = {"t": "s", "kinetic_energy": "J", "energy": "J"}
# The first that fits counts.
UNITS_BY_ENDING = {"rad_per_s": "rad/s", "bytes_per_s": "B/s", "mb_per_s": "MB/s",
                   "gb_per_s": "GB/s", "_per_s": "1/s", "_ns": "ns", "_us": "us", "_s": "s",
                   "_j": "J", "_m": "m", "_bytes": "B", "_pa": "Pa", "_hz": "Hz"}


@functools.cache
def meanings() -> dict[str, tuple[str, str]]:
    """What columns of tables mean: {column: (meaning, unit)}, from the program itself."""
    from .program import program  # pylint: disable=import-outside-toplevel,cyclic-import
    words = [program(), "list", "columns", "--json"]
    listing = json.loads(subprocess.run(words, capture_output=True, text=True, check=True).stdout)
    return {name: (row["meaning"], row["unit"])
            for row in listing for name in (row["run --json"], row["raw"]) if name}


def frame_of(path: str | os.PathLike[str], units: Callable[[str], str]) -> pd.DataFrame:
    """A CSV file. `units` is a function of the column."""
    path = pathlib.Path(path)
    try:
        frame = pd.read_csv(path, dtype={"state_digest": str}, float_precision="round_trip")
    except (OSError, ValueError) as error:
        raise _core.InputError(f"{path}: {error}") from None
    frame.attrs["source"] = str(path)
    frame.attrs["units"] = {column: units(column) for column in frame.columns if units(column)}
    return frame


def unit_of_column(column: str) -> str:
    """Unit of a column of a table; empty if it has none."""
    if column in meanings():
        return meanings()[column][1]
    quantity = column.removesuffix("_low").removesuffix("_high")
    return next((unit for end, unit in UNITS_BY_ENDING.items() if quantity.endswith(end)), "")


def unit_in_history(column: str) -> str:
    """Unit of a column of a history. A probe's are NAME.ux and so on."""
    if column in UNITS_OF_HISTORIES:
        return UNITS_OF_HISTORIES[column]
    quantity = column.rpartition(".")[2]
    if quantity.startswith("reaction_"):
        return "N" if quantity[9] == "f" else "N m"
    is_stress = quantity == "von_mises" or re.fullmatch("s[xyz]{2}", quantity)
    return "Pa" if is_stress else UNITS_OF_STATES.get(quantity, "")


def read_state(path: str | os.PathLike[str]) -> pd.DataFrame:
    """The table of `run --state FILE`: a row an element. attrs["units"] has the units."""
    return frame_of(path, lambda column: UNITS_OF_STATES.get(column, ""))


def read_history(path: str | os.PathLike[str]) -> pd.DataFrame:
    """The table of `run --history FILE`: a row a time. attrs["units"] has the units."""
    return frame_of(path, unit_in_history)


def load(folder: str | os.PathLike[str] = "results") -> "Results":
    """The results of a folder, as `make reproduce` or `dssbench experiment --out` leave them."""
    return Results(folder)


class Results:
    """A folder of results: tables, the records that they come from, and how they were measured."""

    def __init__(self, folder: str | os.PathLike[str]):
        self.folder = pathlib.Path(os.fspath(folder))
        if not (self.folder / "tables").is_dir():
            raise _core.InputError(f"{self.folder}: has no folder tables; give one that `dssbench "
                                   "experiment --out` wrote")

    def names(self) -> list[str]:
        """Names of the tables."""
        return sorted(path.stem for path in (self.folder / "tables").glob("*.csv"))

    def table(self, name: str) -> pd.DataFrame:
        """A table. attrs["units"] has the units."""
        return self._frame("tables", name)

    def raw(self, name: str) -> pd.DataFrame:
        """The records of a study: a row a repetition."""
        return self._frame("raw", name)

    def circumstances(self, name: str) -> dict[str, Any]:
        """Machine, build and settings of a study, as a dict."""
        path = self.folder / "raw" / f"{name}.json"
        if not path.is_file():
            raise _core.InputError(f"{path}: there is no such file")
        return json.loads(path.read_text())

    def _frame(self, folder: str, name: str) -> pd.DataFrame:
        path = self.folder / folder / f"{name}.csv"
        if not path.is_file():
            there = ", ".join(sorted(other.stem for other in path.parent.glob("*.csv")))
            raise _core.InputError(f"{path}: there is no such file; {folder} has {there}")
        return frame_of(path, unit_of_column)

    def __repr__(self) -> str:
        return f"<Results {self.folder}: {', '.join(self.names())}>"
