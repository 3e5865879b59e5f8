"""What a chart of the page is: traces and layout for Plotly as plain data, filters, and the same as a table.

Colours are Okabe and Ito's, told apart with any colour vision, as in the other figures. The words "ink", "soft" and "ground" stand for the theme's colours; the page
puts them in.
"""
import dataclasses
import math

import pandas

from ..words import choice, hover, is_missing

OKABE_ITO = ["#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#999999", "#8B6100"]
SYMBOLS = ["circle", "square", "triangle-up", "diamond", "cross", "triangle-down", "pentagon", "star"]
DASHES = {"f64": "solid", "f32": "dot", "f32c": "dash"}


@dataclasses.dataclass
class Filter:
    """A choice of the reader's: traces and rows whose `key` is another one are not shown. `is_single`: one is always chosen.

    `first`: (name, values) of a choice of several at once, which is made when the page opens.
    """
    key: str
    label: str
    is_single: bool = False
    first: tuple = ()


@dataclasses.dataclass
class Chart:
    text: str  # what there is to see, in words: also what a screen reader says of the chart
    table: str
    traces: list
    layout: dict
    rows: pandas.DataFrame  # the same as a table; has `line` and the keys of filters
    columns: dict  # of it, by heading
    filters: list = dataclasses.field(default_factory=list)
    height: int = 460


def ink(colour):
    """Black is the theme's ink."""
    return "ink" if colour in ("#000000", "black") else colour


def by_order(names, choices):
    """A choice for each name, in order, over and over."""
    return {name: choices[place % len(choices)] for place, name in enumerate(names)}


def plain(values, digits=5):
    """Numbers as JSON takes them, and no longer than a chart needs."""
    out = []
    for value in values:
        if is_missing(value) or (isinstance(value, float) and math.isinf(value)):
            out.append(None)
        elif isinstance(value, float):
            out.append(float(f"{value:.{digits}g}"))
        else:
            out.append(value.item() if hasattr(value, "item") else value)
    return out


def points(frame, table, x, y, keys, columns, **style):
    """One trace of the rows of a table: `keys` are columns that are the same in all of them, for filters; `columns` what a point says."""
    first = frame.iloc[0]
    trace = {"type": "scatter", "x": plain(frame[x]), "y": plain(frame[y]), "meta": {key: choice(first[key]) for key in keys},
             "text": [hover(row, table, columns) for _, row in frame.iterrows()], "hovertemplate": "%{text}<extra></extra>", "customdata": plain(frame["line"])}
    trace.update(style)
    return trace


def whiskers(frame, middle, low, high):
    """Intervals of a trace, where they are known."""
    return {"type": "data", "symmetric": False, "thickness": 1, "width": 2, "array": plain((frame[high] - frame[middle]).clip(lower=0).fillna(0)),
            "arrayminus": plain((frame[middle] - frame[low]).clip(lower=0).fillna(0))}


def logarithmic(title, **more):
    return {"type": "log", "title": {"text": title}, "exponentformat": "power", "dtick": None, **more}


def linear(title, **more):
    return {"title": {"text": title}, **more}
