"""The description of a chart: panels of series, axes, words and filters.

A module in charts/ makes a Chart of a table. render/png.py and render/page.py draw it.
The names "ink", "soft" and "ground" stand for the colours of text, of guide lines and of the
background. The page has them in a light and in a dark theme.
"""
import dataclasses
import itertools

import pandas
from tables.words import choice

# The colours of Okabe and Ito, then some of Tol's: any colour vision can tell them apart.
COLOURS = ["#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#999999", "#8B6100",
           "#332288", "#44AA99", "#882255", "#7A1F00"]
MARKS = ["circle", "square", "triangle-up", "diamond", "cross", "triangle-down", "pentagon", "star"]
PRECISION_LINES = {"f64": "solid", "f32": "dot", "f32c": "dash"}


@dataclasses.dataclass(frozen=True)
class Look:
    """How a series is drawn.

    mark: a name of MARKS, "x", "x-thin" or "line-ns"; empty: no marks.
    line: solid, dash, dot or dashdot; empty: points are not joined.
    hatch: of bars, one of / \\ | - + x .
    size: of marks, in pixels of the page
    """
    colour: str = "ink"
    mark: str = ""
    line: str = ""
    hatch: str = ""
    edge: str = ""
    is_hollow: bool = False
    is_step: bool = False
    size: float = 8
    width: float = 1.3
    opacity: float = 1

    def but(self, **changes):
        """This look with some properties changed."""
        return dataclasses.replace(self, **changes)


@dataclasses.dataclass
class Axis:
    """One axis of a panel.

    scale: linear, log or category. ticks: text by value. limits: (low, high); None: by the data.
    categories: all values of a category axis, in order.
    """
    title: str = ""
    scale: str = "linear"
    limits: tuple = (None, None)
    ticks: dict = None
    categories: list = None
    is_reversed: bool = False
    is_at_top: bool = False
    is_percent: bool = False


@dataclasses.dataclass(frozen=True)
class ColourScale:
    """Colours for numbers from `low` to `high`. stops: (place between 0 and 1, colour)."""
    title: str
    low: float
    high: float
    stops: tuple


@dataclasses.dataclass
class Series:
    """Rows of a table that have one look.

    name: identifies it; two series of one panel with the same look must have the same name
    x, y: columns of the values
    keys: values that filters and facets compare, as keys_of gives them
    entry: its entry in the legend, by default the name; series may share one; empty: none
    kind: points, bars, tiles (cells of a matrix) or field (the colour of `z` for each x and y)
    low, high: columns of the interval of the value on axis `interval_of`
    hollow: column of booleans; label: column of texts beside the points
    edge: "top" or "left": drawn at that edge; x is a fraction of the axis
    width: column with the widths of tiles
    """
    name: str
    rows: pandas.DataFrame
    x: str
    y: str
    look: Look
    keys: dict = dataclasses.field(default_factory=dict)
    entry: str = None
    kind: str = "points"
    low: str = ""
    high: str = ""
    interval_of: str = "y"
    hollow: str = ""
    label: str = ""
    edge: str = ""
    z: str = ""
    scale: ColourScale = None
    width: str = ""

    def __post_init__(self):
        self.entry = self.name if self.entry is None else self.entry


@dataclasses.dataclass
class Panel:
    """One pair of axes. height: relative to the other panels of its chart."""
    x: Axis
    y: Axis
    series: list
    height: float = 1


@dataclasses.dataclass
class Filter:
    """A choice of the reader: it hides series and rows with another value of `key`.

    is_single: one value is always chosen
    first: (name, values): these values are chosen when the page opens; a PNG shows them alone
    opens_with: as `first`, but a PNG shows all values
    """
    key: str
    label: str
    is_single: bool = False
    first: tuple = ()
    opens_with: tuple = ()


@dataclasses.dataclass
class Chart:
    """A chart of one table, with its words and its rows.

    rows: have `line` and the keys of the filters; columns: heading by column of `rows`
    heading: what marks, colours and lines mean; findings: what the chart shows
    facets: keys of filters; a PNG has a panel for each of their values, the page shows one value
    legend: (entry, look) of the PNG if it differs from the entries of the series
    height: of the chart on the page [px]; size: of a panel of the PNG [inches]
    titles: title in the PNG by values of the facets
    columns_of_facets: number of facets in one line of the PNG
    is_side_by_side: the PNG has the panels of a facet beside each other
    """
    table: str
    rows: pandas.DataFrame
    columns: dict
    panels: list
    heading: str
    findings: str = ""
    filters: list = dataclasses.field(default_factory=list)
    facets: tuple = ()
    legend: list = None
    height: int = 460
    size: tuple = (4, 3)
    titles: dict = dataclasses.field(default_factory=dict)
    columns_of_facets: int = 3
    is_side_by_side: bool = False

    @property
    def text(self):
        """The words of the chart, for the page and for screen readers."""
        return f"{self.heading} {self.findings}".strip()


def by_order(names, choices):
    """A choice for each name, in order; the choices repeat."""
    return {name: choices[place % len(choices)] for place, name in enumerate(names)}


def colours_of(names, known=None):
    """A colour for each name: its known colour, or one that is not in `known`."""
    known = known or {}
    free = [colour for colour in COLOURS if colour not in known.values()]
    return {**known, **by_order([name for name in names if name not in known], free)}


def looks_of(names, **more):
    """A look for each name: 96 different pairs of colour and mark."""
    pairs = ((COLOURS[place % len(COLOURS)], MARKS[(place + place // 24) % len(MARKS)])
             for place in itertools.count())
    return {name: Look(colour, mark, **more) for name, (colour, mark) in zip(names, pairs)}


def keys_of(rows, *columns):
    """The values that filters compare; each of the columns has one value in all rows."""
    first = rows.iloc[0]
    return {column: choice(first[column]) for column in columns}


def guide(name, points, look, **more):
    """A line without rows in a table. points: (x, y)"""
    return Series(name, pandas.DataFrame(points, columns=["x", "y"]), "x", "y", look, **more)


def marks_in_words(looks):
    """Which mark stands for which name."""
    return ", ".join(f"{look.mark.replace('-', ' ')} {name}" for name, look in looks.items())
