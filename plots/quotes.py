"""Figures that pages quote: they come from the tables of results, never from a keyboard.

A page marks a quotation with its name in quotes.toml, and a table with its name in
page_tables.py. A second name says of what: <!--table problem arm-->.

    It is <!--chain_end-->1751<!--/--> times as fast.

    <!--table chain-->
    | ... |
    <!--/table-->

fill_pages.py writes what stands between the marks. A name trial_NAME quotes the row NAME of
results/trials/tables/trials.csv: figures that somebody measured once, for a choice of design.
"""
import re
import tomllib

from page_tables import TABLES
from tables.results import FAULTS, ROOT, NotMeasured, Results
from tables.words import is_missing, shown

MARK = re.compile(r"<!--(?!table |/)([a-z0-9_]+)-->(.*?)<!--/-->", re.DOTALL)
TABLE = re.compile(r"(<!--table ([a-z0-9_]+)(?: ([a-z0-9_]+))?-->\n)(.*?)(<!--/table-->)",
                   re.DOTALL)


class Unknown(Exception):
    """A page quotes something that is not there; the message says what."""


def ends_of(frame, column):
    """The columns with the ends of a value's interval: x_low, or x_low_s of x_s."""
    for name in (f"{column}_{{}}", re.sub(r"_s$", "", column) + "_{}_s"):
        if name.format("low") in frame:
            return name.format("low"), name.format("high")
    raise Unknown(f"the column {column} has no interval")


def values_of(rows, what, count):
    """The values that a quotation shows. what: a column, or a word and a column.

    count: 3 asks for a value with the ends of its interval
    """
    word, _, column = what.rpartition(" ")
    if what == "count":
        return [len(rows)]
    if column not in rows:
        raise Unknown(f"no column {column}")
    if word == "range":
        return [rows[column].min(), rows[column].max()]
    if word == "inverse_range":  # of a speed-up: how many times slower
        return [1 / rows[column].max(), 1 / rows[column].min()]
    if word:
        return [getattr(rows[column], word)()]
    if len(rows) != 1:
        raise Unknown(f"{len(rows)} rows fit; a quotation is of one")
    columns = [column, *ends_of(rows, column)] if count == 3 else [column]
    return [rows.iloc[0][name] for name in columns]


def quoted(results, line):
    """The text of a quotation. line: "TABLE | CONDITION | VALUE | FORMAT" of quotes.toml."""
    table, condition, what, form = (part.strip() for part in line.split("|"))
    folder, _, name = table.rpartition("/")
    frame = (Results(results.directory / folder) if folder else results).table(name)
    rows = frame.query(condition, engine="python") if condition else frame
    values = values_of(rows, what, form.count("{"))
    if any(map(is_missing, values)):
        raise Unknown(f"tables/{table}.csv has no value of {what} where {condition}")
    return form.format(*values).replace("%", " %")


def of_trial(results, name):
    """The figure of a trial."""
    frame = Results(results.directory / "trials").table("trials", "name", "figure")
    rows = frame[frame["name"] == name]
    if len(rows) != 1:
        raise Unknown(f"trials.csv has {len(rows)} rows {name}")
    return rows.iloc[0]["figure"]


def markdown(head, lines):
    """A table in Markdown."""
    rows = [head, ["---"] * len(head), *lines]
    return "".join(f"| {' | '.join(map(shown, row))} |\n" for row in rows)


def filled(text, results, quotes):
    """(text of a page with present figures, what could not be filled)."""
    faults = []

    def attempt(name, old, make):
        try:
            return make()
        except (Unknown, NotMeasured) as fault:
            faults.append(f"{name}: {fault}")
            return old
        except (*FAULTS, NameError) as fault:  # a table without the rows or columns
            faults.append(f"{name}: {type(fault).__name__}: {fault}")
            return old

    def quotation(match):
        name, old = match.groups()
        line = quotes.get(name)
        new = old
        if name.startswith("trial_"):
            new = attempt(name, old, lambda: of_trial(results, name.removeprefix("trial_")))
        elif line is None:
            faults.append(f"{name}: is not in plots/quotes.toml")
        else:
            new = attempt(name, old, lambda: quoted(results, line))
        return f"<!--{name}-->{new}<!--/-->"

    def table(match):
        begin, name, of, old, end = match.groups()
        if name not in TABLES:
            faults.append(f"table {name}: is not in plots/page_tables.py")
            return match.group(0)
        words = [of] if of else []
        return begin + attempt(name, old, lambda: markdown(*TABLES[name](results, *words))) + end

    return TABLE.sub(table, MARK.sub(quotation, text)), faults


def read_quotes(path=ROOT / "plots" / "quotes.toml"):
    """Quotations by name."""
    return tomllib.loads(path.read_text(encoding="utf-8"))
