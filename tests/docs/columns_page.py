#!/usr/bin/python3
"""Prints the page results/columns.md from the program's list of columns.

Example: dssbench list columns --json | tests/docs/columns_page.py > results/columns.md
"""
import json
import sys

HEAD = """# Columns of records and of timed cells

Made by `make pages` from `dssbench list columns`; a test compares it with the program.
`run --json`: key in the record of a run. `raw`: column of `raw/NAME.csv`. `in tables`: how the
repetitions of a cell become one value of its table. [README.md](README.md) explains the columns
that only tables have.

"""


def page(fields):
    """The text of the page. fields: the rows of `dssbench list columns --json`"""
    heads = list(fields[0])
    rows = [[field[head].replace("|", "\\|") for head in heads] for field in fields]
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    lines += ["| " + " | ".join(f"`{cell}`" if n < 2 and cell else cell
                                for n, cell in enumerate(row)) + " |" for row in rows]
    return HEAD + "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(page(json.load(sys.stdin)), end="")
