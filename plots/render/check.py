"""Checks a figure after its layout.

All text is on the canvas, no legend covers data, and no two series of a panel have the same look.
render/pictures.py runs the check on every figure that it writes.
"""
import matplotlib.colors
import numpy
from matplotlib.collections import PathCollection
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Text

TOLERANCE = 1  # pixels
OUTSIDE = "place it outside of the axes"


class Unreadable(Exception):
    """A figure is unreadable; the message has a line for each violation."""


def violations(figure):
    """A sentence for each violation in a figure."""
    figure.draw_without_rendering()
    return [*text_beyond_canvas(figure), *legends_over_data(figure), *series_alike(figure)]


def is_shown(artist):
    """The artist and its axes are visible."""
    axes = getattr(artist, "axes", None)
    return artist.get_visible() and (axes is None or axes.get_visible())


def tick_labels(axis):
    """(all labels of ticks, those that are drawn); ticks beyond the limits are not drawn."""
    place_of = axis.get_transform().transform
    low, high = sorted(place_of(axis.get_view_interval()))
    room = 1e-9 * (high - low)
    ticks = [*axis.get_major_ticks(), *axis.get_minor_ticks()]
    labels = [label for tick in ticks for label in (tick.label1, tick.label2)]
    places = numpy.repeat(place_of(numpy.array([tick.get_loc() for tick in ticks])), 2)
    is_drawn = axis.get_visible() and axis.axes.axison and axis.axes.get_visible()
    return labels, [label for label, place in zip(labels, places)
                    if is_drawn and low - room <= place <= high + room]


def drawn_texts(figure):
    """All visible texts."""
    axes = [axis for one in figure.axes for axis in (one.xaxis, one.yaxis)]
    ticks = [tick_labels(axis) for axis in axes]
    skipped = {id(label) for labels, _ in ticks for label in labels}
    skipped |= {id(text) for one in figure.axes if not one.axison
                for axis in (one.xaxis, one.yaxis) for text in axis.findobj(Text)}
    texts = [text for text in figure.findobj(Text) if id(text) not in skipped]
    texts += [label for _, labels in ticks for label in labels]
    return [text for text in texts if text.get_text().strip() and is_shown(text)]


def text_beyond_canvas(figure):
    """Texts that are cut off, with the side and the length [pixels]."""
    canvas, found = figure.bbox, []
    for text in drawn_texts(figure):
        box = text.get_window_extent()
        beyond = {"left": canvas.x0 - box.x0, "right": box.x1 - canvas.x1,
                  "lower": canvas.y0 - box.y0, "upper": box.y1 - canvas.y1}
        side = max(beyond, key=beyond.get)
        if beyond[side] > TOLERANCE:
            found.append(f'text "{text.get_text()}" reaches {beyond[side]:.0f} pixels beyond the '
                         f"{side} edge of the canvas; wrap it or make the figure larger")
    return found


def data_artists(axes):
    """Lines, marks and bars with data. Guides over the whole axes, such as axhline, have none."""
    within = (axes.transData, axes.get_xaxis_transform(), axes.get_yaxis_transform())
    for line in axes.lines:
        if is_shown(line) and len(line.get_xdata()) and line.get_transform() not in within[1:]:
            yield line
    yield from (patch for patch in axes.patches if is_shown(patch))
    yield from (one for one in axes.collections
                if isinstance(one, PathCollection) and is_shown(one))


def pixels(artist):
    """Points of an artist on the canvas; a joined line has points along its segments."""
    if isinstance(artist, Patch):
        box = artist.get_window_extent()
        if not numpy.isfinite(box.get_points()).all():
            return numpy.empty((0, 2))
        sides = [numpy.linspace(*ends, 50) for ends in ((box.x0, box.x1), (box.y0, box.y1))]
        return numpy.array(numpy.meshgrid(*sides)).reshape(2, -1).T
    if isinstance(artist, PathCollection):
        return artist.get_offset_transform().transform(artist.get_offsets())
    points = artist.get_transform().transform(numpy.ma.filled(artist.get_xydata(), numpy.nan))
    points = points[numpy.isfinite(points).all(axis=1)]
    if artist.get_linestyle() in ("None", "none", " ", "") or len(points) < 2:
        return points
    parts = numpy.linspace(0, 1, 50)[:, None]
    return numpy.concatenate([a + parts * (b - a) for a, b in zip(points, points[1:])])


def legends_over_data(figure):
    """Legends that cover data or their labels."""
    found = []
    for legend in figure.findobj(Legend):
        if not is_shown(legend):
            continue
        box = legend.get_window_extent()
        words = ", ".join(text.get_text() for text in legend.get_texts()[:3])
        found += [f'the legend "{words}" covers the text "{text.get_text()}"; {OUTSIDE}'
                  for axes in figure.axes for text in axes.texts
                  if is_shown(text) and text.get_text() and box.overlaps(text.get_window_extent())]
        for axes in (one for one in figure.axes if one.get_visible()):
            for artist in data_artists(axes):
                points = pixels(artist)
                inside = ((points > box.min) & (points < box.max)
                          & (points >= axes.bbox.min) & (points <= axes.bbox.max)).all(axis=1)
                if inside.any():
                    found.append(f'the legend "{words}" covers data of {name_of(artist)}; '
                                 f"{OUTSIDE}")
                    break
    return found


def name_of(artist):
    """The name of a series in quotes."""
    return f'"{artist.get_gid() or artist.get_label()}"'


def look_of(artist):
    """The properties that distinguish series: mark, colours, line and hatch."""
    if isinstance(artist, Line2D):
        has_mark = artist.get_marker() not in ("None", "none", " ", "", None)
        mark = (artist.get_marker(), matplotlib.colors.to_hex(artist.get_markerfacecolor())
                if artist.get_markerfacecolor() != "none" else "hollow",
                artist.get_markersize()) if has_mark else ()
        line = artist.get_linestyle()
        line = () if line in ("None", "none", " ", "") else (line, artist.get_linewidth())
        return ("line", matplotlib.colors.to_hex(artist.get_color()), mark, line)
    face = matplotlib.colors.to_hex(artist.get_facecolor(), keep_alpha=True)
    edge = matplotlib.colors.to_hex(artist.get_edgecolor()) if not artist.get_fill() else ""
    return ("patch", face, artist.get_hatch() or "", edge)


def words_of(look):
    """The known properties of a look."""
    return ", ".join(str(part) for part in look[1:] if part)


def series_alike(figure):
    """Pairs of series of one panel with one look. The gid of an artist names its series."""
    found = []
    for axes in figure.axes:
        names = {}
        for artist in [*axes.lines, *axes.patches]:
            if artist.get_gid() is None:
                continue
            other = names.setdefault(look_of(artist), artist.get_gid())
            pair = f'series "{other}" and "{artist.get_gid()}"'
            if other != artist.get_gid() and not any(pair in text for text in found):
                place = axes.get_title(loc="left") or axes.get_title() or axes.get_ylabel()
                found.append(f'panel "{place}": {pair} have the same mark and colour '
                             f"({words_of(look_of(artist))}); give each its own, as looks_of does")
    return found
