"""Numbers and references as text."""
import html
import math
import re

import pandas


def is_missing(value):
    return value is None or (not isinstance(value, str) and pandas.isna(value))


def shown(value, digits=3):
    """A number with a few digits, a text as it is, an empty text for what was not measured."""
    if is_missing(value):
        return ""
    if isinstance(value, str):
        return value
    if isinstance(value, bool):
        return "yes" if value else "no"
    if math.isinf(value):
        return "inf"
    if float(value).is_integer() and abs(value) < 1e7:
        return str(int(value))
    return f"{value:.{digits}g}"


def with_interval(value, low, high):
    """A median with its 95 % interval, where there is one."""
    if is_missing(value):
        return ""
    return shown(value) if is_missing(low) or is_missing(high) else f"{shown(value)} [{shown(low)}, {shown(high)}]"


def problem(scene, overrides, *more):
    """A scene with what was overridden, without the long names of constants."""
    parts = [str(scene), *("" if is_missing(overrides) else str(overrides)).split(), *more]
    return " ".join(part.rsplit("/", 1)[-1].rsplit("constants.", 1)[-1] for part in parts if part)


def escaped(text):
    return html.escape(str(text), quote=True)


def prose(text):
    """A sentence as HTML: `code` between backticks."""
    return re.sub("`([^`]*)`", r"<code>\1</code>", escaped(text))


def hover(row, table, columns):
    """What a point says: its columns by name, and its line. A line break is <br>, as Plotly wants it; long texts are broken."""
    lines = []
    for column, heading in columns.items():
        text = shown(row[column], 4) if column in row.index else ""
        if text:
            words = f"{heading}: {text}"
            while len(words) > 70:
                cut = words.rfind(" ", 0, 70)
                if cut <= 0:
                    break
                lines.append(escaped(words[:cut]))
                words = "   " + words[cut + 1:]
            lines.append(escaped(words))
    lines.append(f"tables/{table}.csv:{row['line']}")
    return "<br>".join(lines)


def choice(value):
    """A value as a filter's choice."""
    return shown(value) or "none"
