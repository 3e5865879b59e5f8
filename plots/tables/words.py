"""Numbers and references as text."""
import html
import math
import re

import pandas

HOVER = 70  # characters in a line of the text of a point


def is_missing(value):
    """The value is None or not a number."""
    return value is None or (not isinstance(value, str) and pandas.isna(value))


def shown(value, digits=3):
    """A number with a few digits, a text as it is, and an empty text for a missing value."""
    if is_missing(value):
        return ""
    if isinstance(value, str):
        return value
    if isinstance(value, bool):
        return "yes" if value else "no"
    if math.isinf(value):
        return "inf"
    if abs(value) < 1e7 and (float(value).is_integer() or abs(value) >= 1000):
        return f"{value:.0f}"
    return f"{value:.{digits}g}"


def with_interval(value, low, high):
    """A median with its 95 % interval, if one is known."""
    if is_missing(value) or is_missing(low) or is_missing(high):
        return shown(value)
    return f"{shown(value)} [{shown(low)}, {shown(high)}]"


def speedup_over(row, base):
    """The speed-up of a row of cells over `base`, measured or scaled, with its interval."""
    for form in ("", "extrapolated_"):
        found = with_interval(*(row.get(f"{form}speedup_vs_{base}{end}")
                                for end in ("", "_low", "_high")))
        if found:
            return found
    return ""


def problem(scene, overrides, *more):
    """A scene with its overridden values; constants have short names."""
    parts = [str(scene), *("" if is_missing(overrides) else str(overrides)).split(), *more]
    return " ".join(part.rsplit("/", 1)[-1].rsplit("constants.", 1)[-1] for part in parts if part)


def escaped(text):
    """Text in HTML, also within quotes."""
    return html.escape(str(text), quote=True)


def prose(text):
    """A sentence as HTML: `code` between backticks."""
    return re.sub("`([^`]*)`", r"<code>\1</code>", escaped(text))


def hover(row, table, columns):
    """The text of a point: its columns by name, and its line in the table.

    columns: heading by column. Lines end with <br>, as Plotly wants it; long ones are broken.
    """
    lines = []
    for column, heading in columns.items():
        text = shown(row[column], 4) if column in row.index else ""
        if text:
            lines += map(escaped, broken(f"{heading}: {text}"))
    return "<br>".join([*lines, f"tables/{table}.csv:{row['line']}"])


def broken(words):
    """A text in lines of at most HOVER characters; further lines are indented."""
    lines = []
    while len(words) > HOVER:
        cut = words.rfind(" ", 0, HOVER)
        if cut <= 0:
            break
        lines.append(words[:cut])
        words = "   " + words[cut + 1:]
    return [*lines, words]


def choice(value):
    """A value as one choice of a filter."""
    return shown(value) or "none"
