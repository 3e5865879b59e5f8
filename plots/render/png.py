"""Draws charts as one PNG: a grid of panels, a heading above it and the legend at its right.

The legend and the heading have their own room. Texts are wrapped to their width. Axes grow until
the labels of their bars fit. So a figure passes check.py.
"""
import dataclasses

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Text

from . import axis_styles, marks, pictures

DPI = 130
HEADING, TITLE, LEGEND = 9, 9, 8.5  # font sizes
PAD = 0.1  # inches round the figure, and beside the legend


def draw(charts, output, source):
    """Writes the figure that `charts` share. source: the note in the PNG

    @throws check.Unreadable if a reader could not read it
    """
    figure = Figure(dpi=DPI, layout="constrained")
    FigureCanvasAgg(figure)
    cells = cells_of(charts)
    rows, columns = (1 + max(cell[place] for cell in cells) for place in (0, 1))
    heights = [max(cell[2].size[1] * cell[3].height for cell in cells if cell[0] == row)
               for row in range(rows)]
    widths = [max(cell[2].size[0] for cell in cells if cell[1] == column)
              for column in range(columns)]
    grid = figure.add_gridspec(rows, columns, height_ratios=heights, width_ratios=widths)
    shown, fields = [], []
    for cell in cells:
        row, column, chart, panel, facet = cell
        axes = figure.add_subplot(grid[row, column])
        fields += draw_panel(axes, chart, panel, facet)
        label_outer(axes, cell, cells)
        if panel is charts[0].panels[0]:
            title = facet_title(chart, facet)
            has_edge = any(series.edge == "top" for series in panel.series)
            axes.set_title(title, fontsize=TITLE, loc="left", pad=13 if has_edge else 4)
        shown += series_of(chart, panel, facet)
    if fields:
        add_colour_scale(figure, *fields[0])
    arrange(figure, charts, shown, sum(widths), sum(heights))
    for _ in range(3):  # wrapping a text changes the layout a little
        figure.draw_without_rendering()
        if not any([wrap_texts(axes) | marks.fit_labels(axes) for axes in figure.axes]):
            break
    figure.set_layout_engine("none")  # keeps the layout
    pictures.save(figure, output, source)


def cells_of(charts):
    """(row, column, chart, panel, facet) of every panel with data."""
    panels = [(chart, panel) for chart in charts for panel in chart.panels]
    count, columns, found = len(panels), charts[0].columns_of_facets, []
    facets = facets_of(charts)
    for place, facet in enumerate(facets):
        for number, (chart, panel) in enumerate(panels):
            if not series_of(chart, panel, facet):
                continue
            if charts[0].is_side_by_side:
                found.append((place, number, chart, panel, facet))
            else:
                row = place // columns * count + number
                found.append((row, place % columns, chart, panel, facet))
    return found


def facets_of(charts):
    """The values of the facets with data, in order."""
    found = {}
    for chart in charts:
        for series in (one for panel in chart.panels for one in panel.series):
            values = tuple(series.keys.get(key) for key in chart.facets)
            if None not in values and "line" in series.rows:
                found[values] = None
    return list(found)


def facet_title(chart, facet):
    """The title of a facet."""
    return chart.titles.get(facet, ", ".join(facet))


def label_outer(axes, cell, cells):
    """Leaves the title of a shared axis to the leftmost and the lowest panel."""
    row, column, chart, panel, _ = cell
    below = [other for other in cells if other[1] == column and other[0] > row]
    if any(other[3].x.title == panel.x.title for other in below):
        axes.set_xlabel("")
    if any(other[3].x.categories and other[3].x is panel.x for other in below):
        axes.tick_params(labelbottom=False)
    beside = [other for other in cells if other[0] == row and other[1] < column]
    if any(other[3].y.title == panel.y.title for other in beside):
        axes.set_ylabel("")


def series_of(chart, panel, facet):
    """The series of one panel; none if it has only guides."""
    wanted = dict(zip(chart.facets, facet))
    first = {one.key: one.first[1] for one in chart.filters if one.first}
    for key, values in first.items():
        if not any(series.keys.get(key) in values for series in panel.series):
            first = {**first, key: ()}

    def fits(series):
        return (all(series.keys.get(key, value) == value for key, value in wanted.items())
                and all(not values or series.keys.get(key, values[0]) in values
                        for key, values in first.items()))
    found = [series for series in panel.series if fits(series)]
    return found if any("line" in series.rows for series in found) else []


def draw_panel(axes, chart, panel, facet):
    """Draws one panel. @returns (colours, scale) of its fields"""
    fields, ends, shown = [], {}, series_of(chart, panel, facet)
    panel = dataclasses.replace(panel, x=with_shown(panel.x, [one.rows[one.x] for one in shown]),
                                y=with_shown(panel.y, [one.rows[one.y] for one in shown]))
    for series in shown:
        if series.kind == "field":
            fields.append((draw_field(axes, series), series.scale))
        else:
            marks.draw(axes, panel, series, ends)
    axis_styles.set_axis(axes, "x", panel.x)
    axis_styles.set_axis(axes, "y", panel.y)
    has_tiles = any(series.kind == "tiles" for series in panel.series)
    for letter, described in (("x", panel.x), ("y", panel.y)):
        if described.scale != "category" and not has_tiles:
            axes.grid(axis=letter, alpha=0.3, linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    return fields


def with_shown(axis, columns):
    """An axis with only the categories that a panel shows."""
    if axis.scale != "category":
        return axis
    shown = {value for values in columns for value in values}
    return dataclasses.replace(axis, categories=[one for one in axis.categories if one in shown])


def draw_field(axes, series):
    """Draws a colour for each x and y."""
    grid = series.rows.pivot(index=series.y, columns=series.x, values=series.z)
    scale = series.scale
    colours = LinearSegmentedColormap.from_list("scale", list(scale.stops))
    return axes.pcolormesh(grid.columns, grid.index, grid.to_numpy(), cmap=colours,
                           norm=Normalize(scale.low, scale.high), shading="gouraud",
                           rasterized=True)


def add_colour_scale(figure, colours, scale):
    """Adds one bar of colours for all panels."""
    bar = figure.colorbar(colours, ax=figure.axes, label=scale.title, extend="max", aspect=40)
    bar.ax.tick_params(labelsize=8)


def wrapped(figure, text, width, size):
    """A text in lines that are at most `width` inches wide."""
    renderer, font, lines = figure.canvas.get_renderer(), FontProperties(size=size), []

    def fits(words):
        return renderer.get_text_width_height_descent(words, font, False)[0] <= width * DPI
    for paragraph in text.split("\n"):
        lines.append("")
        for word in paragraph.split(" "):
            longer = f"{lines[-1]} {word}".strip()
            if lines[-1] and not fits(longer):
                lines.append(word)
            else:
                lines[-1] = longer
    return "\n".join(lines)


def wrap_texts(axes):
    """Wraps the title of a panel and the names of categories below it to their widths.

    @returns whether a text has changed
    """
    figure, width, before, after = axes.figure, axes.bbox.width / DPI, [], []
    for title in (one for one in axes.get_children() if isinstance(one, Text)):
        if title not in axes.texts and title.get_text():
            before.append(title.get_text())
            after.append(wrapped(figure, before[-1], width, TITLE))
            title.set_text(after[-1])
    names = axes.get_xticklabels()
    if axes.xaxis.get_gid() == "category" and names:
        lines = [wrapped(figure, " ".join(name.get_text().split("\n")),
                         0.95 * width / len(names), axis_styles.TICKS) for name in names]
        before += [name.get_text() for name in names]
        after += lines
        axes.set_xticks(axes.get_xticks(), lines)
    return before != after


def arrange(figure, charts, shown, width, height):
    """Sizes the figure: the panels, the legend and the heading have their own room."""
    legend = legend_of(figure, charts, shown)
    box = legend.get_window_extent(figure.canvas.get_renderer()) if legend else None
    aside = box.width / DPI + 2 * PAD if legend else 0
    height = max(height, box.height / DPI + PAD if legend else 0)
    words = "\n".join(dict.fromkeys(chart.heading.replace("`", "") for chart in charts))
    heading = figure.text(0, 1, wrapped(figure, words, width + aside - 2 * PAD, HEADING),
                          fontsize=HEADING, ha="left", va="top")
    above = heading.get_window_extent(figure.canvas.get_renderer()).height / DPI + 2 * PAD
    whole = (width + aside, height + above)
    figure.set_size_inches(whole)
    heading.set_position((PAD / whole[0], 1 - PAD / whole[1]))
    heading.set_in_layout(False)
    if legend:
        legend.set_bbox_to_anchor((1 - aside / whole[0], 0, aside / whole[0], height / whole[1]))
    figure.get_layout_engine().set(rect=(0, 0, width / whole[0], height / whole[1]))


def legend_of(figure, charts, shown):
    """The entries of all charts, or of the shown series; None if there is only one entry."""
    entries, known = dict(entry for chart in charts for entry in chart.legend or ()), set()
    if not any(chart.legend is not None for chart in charts):
        known = {id(series) for series in shown}
    for panel in (panel for chart in charts for panel in chart.panels):
        for series in (one for one in panel.series if id(one) in known):
            entries.setdefault(series.entry, (series.look, series.kind))
    handles = [handle(name, *look) if isinstance(look, tuple) else handle(name, look)
               for name, look in entries.items() if name]
    if len(handles) < 2:
        return None
    legend = figure.legend(handles=handles, loc="upper left", fontsize=LEGEND, frameon=False,
                           borderaxespad=0, numpoints=1)
    legend.set_in_layout(False)
    return legend


def handle(name, look, kind="points"):
    """The sample of a look in the legend."""
    if kind in ("bars", "tiles"):
        return Patch(facecolor=marks.colour(look.colour), hatch=look.hatch * 2, label=name,
                     alpha=marks.TILE if kind == "tiles" else 1,
                     edgecolor=marks.colour(look.edge) if look.edge else "white",
                     linewidth=2 if look.edge else 0)
    return Line2D([], [], label=name, **marks.line_style(look), **marks.mark_style(look))
