"""Turns a chart into traces and a layout of Plotly, as plain data.

report/page.js applies the filters and the colours of the theme. The text of a point is its row in
the table of the section, which page.js reads.
"""
import math
import textwrap

from tables.words import escaped, is_missing

EDGE = 20  # first number of the axes of fractions, which marks at an edge need
GAP = 55  # pixels between panels
NAME = 18  # characters in a line of the name of a category below an axis
GROWTH = 0.75  # each further panel adds this part of the height of a chart


def spec(chart):
    """{traces, layout, height} of a chart, with its panels below each other."""
    traces, layout = [], {}
    height = round(chart.height * (1 + GROWTH * (len(chart.panels) - 1)))
    for number, (panel, domain) in enumerate(zip(chart.panels, domains(chart.panels, height)), 1):
        suffix = str(number) if number > 1 else ""
        layout[f"xaxis{suffix}"] = names_below(panel.x, axis(panel.x))
        layout[f"yaxis{suffix}"] = axis(panel.y)
        # The lowest panel of those that share an axis has its title.
        if any(panel.x is other.x for other in chart.panels[number:]):
            layout[f"xaxis{suffix}"].update(title={"text": ""},
                                            showticklabels=panel.x.scale != "category")
        if len(chart.panels) > 1:
            layout[f"xaxis{suffix}"]["anchor"] = f"y{suffix}"
            layout[f"yaxis{suffix}"].update(anchor=f"x{suffix}", domain=domain)
        for series in panel.series:
            trace = KINDS.get(series.kind, points)(panel, series)
            trace.update(xaxis=f"x{suffix}", yaxis=f"y{suffix}")
            if series.edge:
                to_edge(trace, series, layout, suffix, EDGE + number)
            traces.append(trace)
        if any(series.kind == "bars" for series in panel.series):
            layout["barmode"] = "relative"
    return {"traces": traces, "layout": layout, "height": height}


def domains(panels, height):
    """[low, high] of each panel as fractions of the height, from the top."""
    gap = GAP / height
    room = 1 - gap * (len(panels) - 1)
    whole, top, found = sum(panel.height for panel in panels), 1.0, []
    for panel in panels:
        low = max(top - room * panel.height / whole, 0)
        found.append([round(low, 4), round(top, 4)])
        top = low - gap
    return found


def plain(values, digits=5):
    """Numbers for JSON, with as many digits as a chart needs."""
    out = []
    for value in values:
        if is_missing(value) or (isinstance(value, float) and math.isinf(value)):
            out.append(None)
        elif isinstance(value, float):
            out.append(float(f"{value:.{digits}g}"))
        else:
            out.append(value.item() if hasattr(value, "item") else value)
    return out


def axis(described):
    """An axis of the layout."""
    found = {"title": {"text": described.title.replace("\n", "<br>")}}
    if described.scale == "log":
        found.update(type="log", exponentformat="power", dtick=None)
    if described.scale == "category":
        found.update(type="category", automargin=True)
    if described.categories:
        found.update(categoryorder="array", categoryarray=list(described.categories))
    if described.ticks:
        found.update(tickvals=plain(described.ticks), tickangle=0,
                     ticktext=[escaped(text).replace("\n", "<br>")
                               for text in described.ticks.values()])
    if described.is_at_top:
        found["side"] = "top"
    if described.is_percent:
        found["tickformat"] = ".0%"
    found.update(limits(described))
    return found


def names_below(described, found):
    """Breaks names of categories below an axis into short lines."""
    if described.scale == "category" and described.categories and not described.is_at_top:
        lines = ["<br>".join(textwrap.wrap(str(name), NAME)) for name in described.categories]
        found.update(tickvals=list(described.categories), ticktext=lines, tickangle=0)
    return found


def limits(described):
    """The range of an axis."""
    low, high = described.limits
    if low == 0 and high is None:
        return {"rangemode": "tozero"}
    if low is not None and high is not None:
        ends = [math.log10(end) if described.scale == "log" else end for end in (low, high)]
        return {"range": ends[::-1] if described.is_reversed else ends}
    return {"autorange": "reversed"} if described.is_reversed else {}


def marker(look, hollow=None):
    """Marks of a look. hollow: for each point, if the points differ"""
    is_open = [look.is_hollow] if hollow is None else hollow
    symbols = [look.mark + ("-open" if one else "") for one in is_open]
    is_thick, is_thin = look.mark == "line-ns" or look.edge, look.mark != "x-thin"
    edge = 3 if is_thick else 1 if is_thin and not look.is_hollow else 2
    return {"size": look.size, "symbol": symbols[0] if hollow is None else symbols,
            "color": look.colour, "line": {"width": edge, "color": look.edge or look.colour}}


def whiskers(series):
    """The intervals of a series."""
    middle = series.rows[series.x if series.interval_of == "x" else series.y]
    up, down = series.rows[series.high] - middle, middle - series.rows[series.low]
    return {"type": "data", "symmetric": False, "thickness": 1, "width": 2,
            "array": plain(up.clip(lower=0).fillna(0)),
            "arrayminus": plain(down.clip(lower=0).fillna(0))}


def common(series):
    """The part of a trace that all kinds have: data, keys of filters, and lines of points."""
    rows = series.rows
    trace = {"x": plain(rows[series.x]), "y": plain(rows[series.y]), "meta": series.keys,
             "name": series.entry, "legendgroup": series.entry, "opacity": series.look.opacity}
    if "line" in rows:
        trace["hovertemplate"], trace["customdata"] = "%{text}<extra></extra>", plain(rows["line"])
    else:
        trace["hoverinfo"] = "skip"
    if series.low and series.high and {series.low, series.high} <= set(rows):
        trace[f"error_{series.interval_of}"] = whiskers(series)
    return trace


def points(panel, series):
    """Marks, lines, or both; tiles are marks too."""
    look, trace = series.look, common(series)
    modes = ["lines"] * bool(look.line) + ["markers"] * bool(look.mark)
    trace.update(type="scatter", mode="+".join(modes))
    if look.line:
        trace["line"] = {"color": look.colour, "width": look.width, "dash": look.line,
                         "shape": "hv" if look.is_step else "linear"}
    if look.mark:
        trace["marker"] = marker(look, list(series.rows[series.hollow]) if series.hollow else None)
    return trace


def bars(panel, series):
    """Bars with their labels beside them."""
    trace = common(series)
    trace.update(type="bar", orientation="h" if panel.y.scale == "category" else "v",
                 hovertemplate="%{hovertext}<extra></extra>",
                 marker={"color": series.look.colour,
                         "pattern": {"shape": series.look.hatch, "fillmode": "overlay",
                                     "fgcolor": "ground", "size": 6, "solidity": 0.25}},
                 textposition="none")
    if series.label:
        trace.update(text=list(series.rows[series.label]), textposition="outside",
                     cliponaxis=False)
    return trace


def field(panel, series):
    """A colour for each x and y."""
    grid = series.rows.pivot(index=series.y, columns=series.x, values=series.z)
    scale = series.scale
    values = grid.to_numpy().clip(max=scale.high).tolist()
    return {"type": "heatmap", "x": plain(grid.columns), "y": plain(grid.index),
            "z": [plain(line, 4) for line in values], "zmin": scale.low, "zmax": scale.high,
            "colorscale": [list(stop) for stop in scale.stops], "meta": series.keys,
            "colorbar": {"title": {"text": scale.title, "side": "right"}, "thickness": 12},
            "name": series.entry, "hovertemplate": f"{panel.x.title}: %{{x:.3g}}<br>"
            f"{panel.y.title}: %{{y:.3g}}<br>{scale.title}: %{{z:.4g}}<extra></extra>"}


def to_edge(trace, series, layout, suffix, number):
    """Moves a trace to axes of fractions that lie over those of its panel."""
    def over(letter):
        layout[f"{letter}axis{number}"] = {"overlaying": f"{letter}{suffix}", "range": [0, 1],
                                           "visible": False, "fixedrange": True}
        trace[f"{letter}axis"] = f"{letter}{number}"
    over("x")
    if series.edge == "top":
        over("y")
        trace["y"] = [0.985] * len(series.rows)


KINDS = {"bars": bars, "field": field}
