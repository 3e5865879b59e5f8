"""Numbers and references as text."""
import html
import math
import re

import pandas

PREFIXES = {"T": 1e12, "G": 1e9, "M": 1e6}


def is_missing(value):
    """The value is None or not a number."""
    return value is None or (not isinstance(value, str) and pandas.isna(value))


def plain(value, digits=3):
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


def shown(value, digits=3):
    """A value as people read it: 1,751 or 68.7 M or 8.5e-5; texts as `plain` gives them."""
    if is_missing(value) or isinstance(value, (str, bool)) or math.isinf(value):
        return plain(value)
    rounded = abs(float(f"{value:.{digits}g}"))
    if rounded >= 1e15:
        return f"{value:.{digits}g}".replace("e+", "e")
    for prefix, unit in PREFIXES.items():
        if rounded >= unit:
            return f"{few_digits(value / unit, digits)} {prefix}"
    if float(value).is_integer() or rounded >= 1000:
        return f"{value:,.0f}"
    return few_digits(value, digits)


def few_digits(value, digits):
    """A number with a few digits: 120, 1.5, 8.5e-5."""
    text = f"{value:.{digits}g}"
    return f"{float(text):,.0f}" if "e+" in text else text.replace("e-0", "e-")


def is_number(text):
    """The text is a number, with or without its interval."""
    return re.fullmatch(r"[~ ]*[-\d][-\d.,e]*( [A-Z%]*)?( \[[^\]]*\])?", text) is not None


def with_interval(value, low, high):
    """A median with its 95 % interval, if one is known."""
    if is_missing(value) or is_missing(low) or is_missing(high):
        return shown(value)
    between = "; " if "," in shown(low) + shown(high) else ", "
    return f"{shown(value)} [{shown(low)}{between}{shown(high)}]"


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


def breakable(text):
    """Text in HTML whose long names may be broken after an underscore, comma or sign."""
    return re.sub(r"([_,=@])(?=\S)", r"\1<wbr>", escaped(text))


def prose(text):
    """A sentence as HTML: `code` between backticks."""
    return re.sub("`([^`]*)`", r"<code>\1</code>", escaped(text))


def choice(value):
    """A value as one choice of a filter."""
    return plain(value) or "none"
