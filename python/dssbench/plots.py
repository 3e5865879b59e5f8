"""Figures of results, with matplotlib. Each function returns the axes."""
from typing import Any, Sequence

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.axes import Axes

from .simulation import Simulation


def label_of(frame: pd.DataFrame, column: str) -> str:
    """Column and unit."""
    unit = frame.attrs.get("units", {}).get(column, "")
    return f"{column} [{unit}]" if unit else column


def lines(frame: pd.DataFrame, x: str, y: str | Sequence[str], by: str | None = None,
          low: str | None = None, high: str | None = None, axes: Axes | None = None) -> Axes:
    """Draws columns `y` over `x`, one line for each value of `by`.

    y          a column, or several (of one unit)
    low, high  columns of the interval of y, drawn as a bar
    """
    axes = axes or plt.subplots(layout="constrained")[1]
    columns = [y] if isinstance(y, str) else list(y)
    for value, part in [("", frame)] if by is None else frame.groupby(by, sort=False):
        part = part.sort_values(x)
        for column in columns:
            words = [str(value)] * (by is not None) + [column] * (len(columns) > 1)
            bars = None
            if low is not None and high is not None:
                bars = [part[column] - part[low], part[high] - part[column]]
            axes.errorbar(part[x], part[column], yerr=bars, marker="o", markersize=3, capsize=3,
                          label=" ".join(words) or None)
    axes.set_xlabel(label_of(frame, x))
    axes.set_ylabel(label_of(frame, columns[0]))
    if by is not None or len(columns) > 1:
        axes.legend()
    return axes


def body(simulation: Simulation, values: Any = None, label: str = "",
         axes: Axes | None = None) -> Axes:
    """Draws the elements of a simulation where they are, seen along z, coloured by values.

    values  one for each element; default: the length of its displacement [m]
    """
    axes = axes or plt.subplots(layout="constrained")[1]
    displacement = simulation.displacement
    if values is None:
        values, label = (displacement**2).sum(axis=1)**0.5, "displacement [m]"
    places = simulation.places() + displacement
    drawn = axes.scatter(places[:, 0], places[:, 1], c=values, s=4, marker="s")
    axes.figure.colorbar(drawn, ax=axes, label=label)
    axes.set(xlabel="x [m]", ylabel="y [m]", aspect="equal",
             title=f"{simulation.name}, t = {simulation.time:.4g} s")
    return axes
