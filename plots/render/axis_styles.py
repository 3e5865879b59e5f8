"""Puts an Axis of a chart on axes of Matplotlib: scale, limits, ticks and title."""
import math

from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter, NullLocator

TITLE, TICKS = 9, 8  # font sizes


def set_axis(axes, letter, described):
    """Sets the x or the y axis."""
    axis = axes.xaxis if letter == "x" else axes.yaxis
    if described.scale == "log":
        axes.set(**{f"{letter}scale": "log"})
    if described.scale == "category":
        count = len(described.categories)
        axis.set_ticks(range(count), [str(name) for name in described.categories])
        axis.set_gid("category")
        ends = (-0.6, count - 0.4)
    else:
        ends = [known if known is not None else found for known, found in
                zip(described.limits, axes.get_xlim() if letter == "x" else axes.get_ylim())]
    ends = ends[::-1] if described.is_reversed else ends
    axes.set(**{f"{letter}lim": ends})
    if described.is_at_top:
        axis.tick_top()
        axis.set_label_position("top")
    axis.set_tick_params(labelsize=TICKS)
    axis.label.set_text(described.title)
    axis.label.set_size(TITLE)
    set_ticks(axis, described)


def set_ticks(axis, described):
    """Sets ticks: with given words, in per cent, or few enough to be readable."""
    if described.ticks:
        axis.set_ticks(list(described.ticks), list(described.ticks.values()))
        axis.set_minor_locator(NullLocator())
    elif described.is_percent:
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{100 * value:.0f} %"))
    elif described.scale == "log":
        low, high = sorted(axis.get_view_interval())
        decades = math.log10(high / low)
        axis.set_minor_formatter(NullFormatter())
        if decades < 2:
            axis.set_minor_locator(NullLocator())
            few = decades < 0.7
            axis.set_major_locator(MaxNLocator(4) if few else LogLocator(subs=steps(decades)))
            axis.set_major_formatter(FuncFormatter(lambda value, _: number(value)))


def steps(decades):
    """The factors of a power of ten that have a tick, for an axis of this length."""
    return (1, 2, 5) if decades < 1.3 else (1, 3)


def number(value):
    """A number in few characters."""
    if value == 0 or 1e-3 <= abs(value) < 1e5:
        return f"{value:.3g}" if abs(value) < 1000 else f"{value:g}"
    mantissa, exponent = f"{value:.1e}".split("e")
    mantissa = mantissa.removesuffix(".0")
    return rf"${mantissa}\cdot10^{{{int(exponent)}}}$"
