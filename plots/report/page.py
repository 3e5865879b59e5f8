"""The whole page: its sections, data of its charts and the library, put into page.html."""
import json
import pathlib
import string

from render.page import spec
from tables.words import escaped

from .elements import element, elements

HERE = pathlib.Path(__file__).parent


def text_of(name):
    """The text of a file of this folder."""
    return (HERE / name).read_text(encoding="utf-8")


def safe_json(data):
    """JSON that cannot end the script it stands in."""
    return json.dumps(data, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")


def entry(name, title):
    """A line of the contents."""
    return element("a", escaped(title), href=f"#{name}")


def assemble(origin, contents, body, charts, library):
    """The text of the page.

    contents: (id, title, the same of its parts) of each chapter; body: sections; charts: by the
    name of their section; library: the text of plotly.min.js, or empty
    """
    specs = {name: spec(chart) for name, chart in charts.items()} if library else {}
    links = [entry(name, title) + (element("ul", elements("li", (entry(*part) for part in parts)))
                                   if parts else "") for name, title, parts in contents]
    return string.Template(text_of("page.html")).substitute(
        style=text_of("page.css"), origin=origin, contents=element("ul", elements("li", links)),
        body="\n".join(body), charts=safe_json(specs), library=library, script=text_of("page.js"))
