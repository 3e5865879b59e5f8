"""A directory of results: tables with the line of each row, and reasons for what is missing."""
import dataclasses
import pathlib

import pandas

ROOT = pathlib.Path(__file__).resolve().parents[2]


class NotMeasured(Exception):
    """A part of the report cannot be shown; the message says why."""


# The code that draws a table raises these if the table has values of an unexpected kind.
FAULTS = (LookupError, ValueError, TypeError, AttributeError, ArithmeticError)


# Tables of studies for users, which `make reproduce` leaves out.
ON_DEMAND = ("table1_host", "bodies")


@dataclasses.dataclass(frozen=True)
class Lack:
    """A section that is missing. is_fault: its table is there, but cannot be drawn."""
    name: str
    title: str
    table: str
    reason: str
    is_fault: bool = False


class Results:
    """tables/ and raw/ of one directory; a table is read once."""

    def __init__(self, directory):
        self.directory = pathlib.Path(directory)
        self._read = {}

    def table(self, name, *needed, optional=()):
        """Rows of tables/NAME.csv; the column `line` is the line of a row in the file.

        needed: columns that have values. optional: columns that may be empty; the program leaves
        out columns that are empty in every row, and they are added here.
        @throws NotMeasured if the table, or a needed column, is missing
        """
        if name not in self._read:
            self._read[name] = self._load(name)
        frame = self._read[name]
        missing = [column for column in needed if column not in frame.columns]
        if missing:
            raise NotMeasured(f"tables/{name}.csv is of another version: it has no column "
                              f"{', '.join(missing)}")
        return frame.reindex(columns=list(dict.fromkeys([*frame.columns, *optional])))

    def has(self, name):
        """The table is there."""
        return (self.directory / "tables" / f"{name}.csv").exists()

    def _load(self, name):
        path = self.directory / "tables" / f"{name}.csv"
        if not path.exists():
            raise NotMeasured("not measured")
        try:
            # An empty value means "not measured"; `none` is a word.
            frame = pandas.read_csv(path, keep_default_na=False, na_values=["", "nan"])
        except (ValueError, UnicodeDecodeError) as fault:
            raise NotMeasured(f"tables/{name}.csv cannot be read: {fault}") from None
        if frame.empty:
            raise NotMeasured(f"tables/{name}.csv has no rows")
        frame["line"] = range(2, len(frame) + 2)  # line 1 has the names of the columns
        return frame

    def names(self):
        """Names of all tables."""
        return sorted(path.stem for path in (self.directory / "tables").glob("*.csv"))

    def expects(self, table):
        """False if a table is not there and no reproduction makes it."""
        return table not in ON_DEMAND or self.has(table)

    def others(self):
        """Results of other machines, in folders of this one such as results/h100."""
        found = sorted(self.directory.glob("*/tables/table3.csv"))
        return [Results(path.parent.parent) for path in found]

    def figures(self):
        """Files of all figures."""
        return sorted((self.directory / "figures").glob("*.png"))


def is_pair(frame):
    """Rows of an A/A pair: one cell measured as if it were two."""
    return frame["label"].fillna("").str.contains("A/A", regex=False)


def studies():
    """Names of the studies that `dssbench list experiments` shows."""
    return sorted(path.stem for path in (ROOT / "experiments" / "studies").glob("*/*.json"))


def study_of(table):
    """The study that writes a table: the longest study name that the table name begins with."""
    known = [name for name in studies() if table == name or table.startswith(f"{name}_")]
    special = {"cluster_simulated": "cluster", "ceilings": "kernels", "attribution": "kernels",
               "paper_figure9": "paper_table3"}
    return special.get(table) or max(known, key=len, default=table)
