"""Draws series of a chart on axes of Matplotlib. The gid of an artist names its series."""
from matplotlib.patches import Rectangle

THEME = {"ink": "#000000", "soft": "#6b6b6b", "ground": "#ffffff"}
MARKS = {"circle": "o", "square": "s", "triangle-up": "^", "diamond": "D", "cross": "P",
         "triangle-down": "v", "pentagon": "p", "star": "*", "x": "X", "x-thin": "x",
         "line-ns": "|"}
LINES = {"solid": "-", "dash": "--", "dot": ":", "dashdot": "-."}
SIZE = 0.65  # points for a pixel of the page
LABEL = 8  # font size
TILE = 0.55  # opacity: black text stands on it
LABEL_GAP = 4  # points between a bar and its label


def colour(name):
    """A colour, which may be one of the theme."""
    return THEME.get(name, name)


def line_style(look):
    """The properties of Line2D for the line of a look."""
    if not look.line:
        return {"linestyle": "none", "color": colour(look.colour)}
    return {"linestyle": LINES[look.line], "linewidth": 0.85 * look.width,
            "color": colour(look.colour), "alpha": look.opacity,
            "drawstyle": "steps-post" if look.is_step else "default"}


def mark_style(look):
    """The properties of Line2D for the marks of a look."""
    if not look.mark:
        return {}
    face = "none" if look.is_hollow else colour(look.colour)
    edge = 2.2 if look.mark == "line-ns" else 1.5 if look.mark == "x-thin" else 1
    return {"marker": MARKS[look.mark], "markersize": SIZE * look.size, "markerfacecolor": face,
            "markeredgecolor": colour(look.edge or look.colour), "markeredgewidth": edge}


def draw(axes, panel, series, ends):
    """Draws points, bars or tiles. ends: of the bars that are already drawn"""
    if series.kind == "bars":
        draw_bars(axes, panel, series, ends)
    elif series.kind == "tiles":
        draw_tiles(axes, series)
    else:
        draw_points(axes, panel, series)


def places(axis, values):
    """Values on an axis; the values of a category axis are numbered."""
    if axis.scale == "category":
        return values.map({name: place for place, name in enumerate(axis.categories)})
    return values


def draw_points(axes, panel, series):
    """Draws marks, lines or both; hollow marks are drawn over the filled ones."""
    rows = series.rows
    x, y, more = places(panel.x, rows[series.x]), places(panel.y, rows[series.y]), {}
    if series.edge == "top":
        y, more = 0 * x + 1.03, {"transform": axes.transAxes, "clip_on": False}
    if series.edge == "left":
        more = {"transform": axes.get_yaxis_transform()}
    look, is_hollow = series.look, rows[series.hollow].astype(bool) if series.hollow else None
    axes.plot(x, y, gid=series.name, zorder=2 if look.opacity < 1 else 3, **line_style(look),
              **mark_style(look), **more)
    if is_hollow is not None and is_hollow.any():
        style = {**mark_style(look), "markerfacecolor": "white"}
        axes.plot(x[is_hollow], y[is_hollow], linestyle="none", zorder=4, **style, **more)
    draw_interval(axes, series, x, y)


def draw_interval(axes, series, x, y):
    """Draws whiskers where an interval is known."""
    rows = series.rows
    if not series.low or not {series.low, series.high} <= set(rows):
        return
    middle = rows[series.x if series.interval_of == "x" else series.y]
    known = rows[series.low].notna() & rows[series.high].notna() & middle.notna()
    if series.hollow:
        known &= ~rows[series.hollow].astype(bool)
    if known.any():
        reach = [(middle - rows[series.low])[known].clip(lower=0),
                 (rows[series.high] - middle)[known].clip(lower=0)]
        ink = "black" if series.kind == "bars" else colour(series.look.colour)
        axes.errorbar(x[known], y[known], fmt="none", ecolor=ink, elinewidth=0.9, capsize=2,
                      zorder=4, **{f"{series.interval_of}err": reach})


def draw_bars(axes, panel, series, ends):
    """Draws bars and stacks those of one place; a logarithmic axis starts them at its limit."""
    rows, is_flat = series.rows, panel.y.scale == "category"
    where, along = (panel.y, panel.x) if is_flat else (panel.x, panel.y)
    at = places(where, rows[series.y if is_flat else series.x])
    values = rows[series.x if is_flat else series.y].fillna(0)
    floor = (along.limits[0] or 0) if along.scale == "log" else 0
    starts = [ends.get((place, value < 0), floor) for place, value in zip(at, values)]
    lengths = [max(value, floor) - floor if floor else value for value in values]
    for place, value, start, length in zip(at, values, starts, lengths):
        ends[place, value < 0] = start + length
    look = {"color": colour(series.look.colour), "zorder": 2, "edgecolor": "white",
            "linewidth": 0, "hatch": 2 * series.look.hatch or None, "gid": series.name}
    if is_flat:
        axes.barh(at, lengths, left=starts, **look)
    else:
        axes.bar(at, lengths, bottom=starts, **look)
    draw_interval(axes, series, *((rows[series.x], at) if is_flat else (at, rows[series.y])))
    if series.label:
        highs = rows[series.high] if series.high in rows else values
        reach = highs.fillna(values).clip(lower=floor)
        for text, place, end in zip(rows[series.label], at, reach):
            add_label(axes, text, place, end, is_flat)


def add_label(axes, text, place, end, is_flat):
    """Writes a text beside the end of a bar; fit_labels makes room for it."""
    where, offset = ((end, place), (LABEL_GAP, 0)) if is_flat else ((place, end), (0, LABEL_GAP))
    axes.annotate(text, where, xytext=offset, textcoords="offset points", fontsize=LABEL,
                  ha="left" if is_flat else "center", va="center" if is_flat else "bottom",
                  gid="label", zorder=5, annotation_clip=False,
                  bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5, "alpha": 0.8}
                  ).set_in_layout(False)


def fit_labels(axes):
    """Moves the limits of axes so that labels of bars end within them.

    @returns whether a limit has changed
    """
    has_grown = False
    labels = [text for text in axes.texts if text.get_gid() == "label" and text.get_text()]
    for dimension, limits, set_limits in ((0, axes.get_xlim, axes.set_xlim),
                                          (1, axes.get_ylim, axes.set_ylim)):
        low, high = limits()
        start, length = axes.bbox.min[dimension], axes.bbox.size[dimension]
        growth = 1.0
        for label in labels:
            anchor = axes.transData.transform(label.xy)[dimension]
            end = label.get_window_extent().max[dimension]
            if end > start + length and anchor > start:
                room = max(length - 2 - (end - anchor), 0.1 * length)
                growth = max(growth, (anchor - start) / room)
        if growth > 1:
            scale = (axes.xaxis, axes.yaxis)[dimension].get_transform()
            first, last = scale.transform([low, high])
            set_limits(low, scale.inverted().transform([first + growth * (last - first)])[0])
            has_grown = True
    return has_grown


def draw_tiles(axes, series):
    """Draws cells of a matrix, centred at their x and y, with their labels."""
    for _, row in series.rows.iterrows():
        width = row[series.width] if series.width else 1
        corner = (row[series.x] - width / 2, row[series.y] - 0.5)
        edge = colour(series.look.edge) if series.look.edge else "none"
        axes.add_patch(Rectangle(corner, width, 1, facecolor=colour(series.look.colour), zorder=2,
                                 alpha=TILE, edgecolor="white", gid=series.name))
        if series.look.edge:
            axes.add_patch(Rectangle(corner, width, 1, fill=False, edgecolor=edge, linewidth=2,
                                     zorder=4))
        if series.label and row[series.label]:
            axes.annotate(row[series.label], (row["label_x"], row[series.y]), ha="center",
                          va="center", fontsize=LABEL - 0.5, zorder=5)
