"""The page: sections of text, tables and charts, put into page.html."""
import base64
import json
import pathlib
import string

from render import pictures
from render.page import spec
from tables.results import NotMeasured, study_of
from tables.words import choice, escaped, is_missing, prose, shown

HERE = pathlib.Path(__file__).parent
PICTURES = {"plate_paper.png": "The paper's plate, deformed, coloured by von Mises stress", "l_bracket.png": "The bracket of the scene l_bracket, deformed, coloured by von Mises stress",
            "l_bracket_frames.png": "The bracket over time"}


def link(path, line=None):
    """A file from the directory of results, with a line of it."""
    return f'<a href="{escaped(path)}">{escaped(path)}{f":{line}" if line else ""}</a>'


def element(tag, content, **attributes):
    words = "".join(f' {name.rstrip("_").replace("_", "-")}="{escaped(value)}"' for name, value in attributes.items() if value not in (None, ""))
    return f"<{tag}{words}>{content}</{tag}>"


def scrolling(table, label, more=""):
    """Wide tables scroll by themselves, by keyboard too."""
    return element("div", table, class_=f"scroll {more}".strip(), tabindex="0", role="region", aria_label=label)


def command(study, scale):
    return f"<code>dssbench experiment {escaped(study)}{f' --scale {escaped(scale)}' if scale else ''}</code>"


def age_line(is_old, text):
    text = escaped(text)
    if is_old:
        text = text.replace("old", '<strong class="old">old</strong>', 1)
    return element("p", text, class_="age")


def source_line(tables, made_by):
    return element("p", f"From {', '.join(link(f'tables/{name}.csv') for name in tables)}; made by {made_by}.", class_="source")


SEVERAL = "\n"  # between values of one choice, as page.js has it


def select(key, label, values, is_single, first=()):
    options = [] if is_single else ['<option value="">all</option>']
    several = [value for value in first[1] if value in values] if first else []
    if several:
        options.insert(0, element("option", escaped(first[0]), value=SEVERAL.join(several), selected="selected"))
    options += [element("option", escaped(value), value=value) for value in values]
    return f"<label>{escaped(label)}{element('select', ''.join(options), name=key)}</label>"


def filters(choices, label):
    """choices: what `select` takes, of each; one that has a single value filters nothing."""
    shown_ones = [select(*one) for one in choices if len(one[2]) > 1]
    return element("div", "".join(shown_ones) + "<output></output>", class_="filters", role="group", aria_label=f"Filters: {label}") if shown_ones else ""


def chart_table(chart):
    """The same as a table: what a screen reader, or who wants the numbers, takes."""
    columns = {column: heading for column, heading in chart.columns.items() if column in chart.rows and chart.rows[column].notna().any()}
    head = "".join(element("th", escaped(heading), scope="col") for heading in ["row", *columns.values()])
    lines = []
    for _, row in chart.rows.iterrows():
        keys = json.dumps({one.key: choice(row[one.key]) for one in chart.filters if one.key in row.index})
        cells = element("td", link(f"tables/{chart.table}.csv", row["line"])) + "".join(element("td", escaped(shown(row[column], 4))) for column in columns)
        lines.append(element("tr", cells, data_keys=keys, data_line=row["line"]))
    return f"<table><thead><tr>{head}</tr></thead><tbody>{''.join(lines)}</tbody></table>"


def chart_section(name, title, chart, age, scale, has_library):
    choices = [(one.key, one.label, list(dict.fromkeys(choice(value) for value in chart.rows[one.key])), one.is_single, one.first) for one in chart.filters if one.key in chart.rows]
    picture = element("div", "", class_="chart", role="img", aria_label=f"{title}. {chart.text}", data_chart=name)
    if not has_library:
        picture = element("p", "Without Plotly there is no chart; its table is below.", class_="missing")
    body = [element("h3", escaped(title)), age_line(*age), element("p", prose(chart.text)), filters(choices, title), picture,
            f"<details><summary>As a table, {len(chart.rows)} rows</summary>{scrolling(chart_table(chart), title)}</details>", source_line([chart.table], command(study_of(chart.table), scale))]
    return element("section", "\n".join(body), class_="part", id=name)


def missing_section(lack):
    text = escaped(lack.reason[0].upper() + lack.reason[1:]) + ("" if lack.is_fault else f": run {command(study_of(lack.table), '')}")
    return element("section", element("h3", escaped(lack.title)) + element("p", text, class_="missing"), id=lack.name, data_missing="yes")


def grid_section(grid, age, made_by, folder=""):
    """Tables 1 to 3: columns of a kind have a colour and a heading of their own."""
    kinds = [(kind, place == 0) for kind, _, columns in grid.groups for place in range(len(columns))]
    above = "".join(element("th", escaped(heading), colspan=len(columns), scope="colgroup", class_=f"{kind} first".strip()) for kind, heading, columns in grid.groups)
    below = "".join(element("th", escaped(column), scope="col", class_=f"{kind}{' first' * is_first}".strip())
                    for (kind, is_first), column in zip(kinds, [column for _, _, columns in grid.groups for column in columns]))
    lines = []
    for number, row in enumerate(grid.rows):
        cells = []
        for place, (cell, (kind, is_first)) in enumerate(zip(row, kinds)):
            text = f'<a href="{escaped(cell.table)}.csv" title="{escaped(cell.table)}.csv:{cell.line}">{escaped(cell.text)}</a>' if cell.table else escaped(cell.text)
            cells.append(element("td" if place else "th", text, class_=f"{kind}{' first' * is_first}".strip(), scope="" if place else "row"))
        keys = json.dumps({label: values[number] for label, values in grid.filters.items()})
        lines.append(element("tr", "".join(cells), data_keys=keys))
    table = f"<table><thead><tr>{above}</tr><tr>{below}</tr></thead><tbody>{''.join(lines)}</tbody></table>"
    choices = [(label, label, list(dict.fromkeys(values)), False) for label, values in grid.filters.items()]
    sources = ", ".join(link(f"{folder}tables/{name}.csv") for name in grid.tables)
    body = [element("h3", escaped(grid.title)), age_line(*age), filters(choices, grid.title), scrolling(table, grid.title, "grid tall" if len(lines) > 15 else "grid"), *[element("p", prose(note), class_="note") for note in grid.notes],
            element("p", f"From {sources}; made by {made_by}.", class_="source")]
    return element("section", "\n".join(body), class_="part", id=grid.name)


def plain_table(headings, rows):
    """Rows of ready HTML."""
    head = "".join(element("th", escaped(heading), scope="col") for heading in headings)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{''.join('<tr>' + ''.join(element('td', cell) for cell in row) + '</tr>' for row in rows)}</tbody></table>"


def value_text(value):
    if isinstance(value, dict):
        return ", ".join(f"{name} {value_text(part)}" for name, part in value.items())
    if isinstance(value, list):
        return "; ".join(value_text(part) for part in value)
    return "" if is_missing(value) else str(value)


def environment_section(ages):
    """What made each record, and everything that the newest says."""
    if not ages.records:
        return element("section", element("h2", "Environment") + element("p", "Not recorded: there is no raw/NAME.json.", class_="missing"), id="environment")
    rows = []
    for record in sorted(ages.records.values(), key=lambda record: record.last, reverse=True):
        context = record.context
        words = "; ".join([*record.reasons, *([record.kept_text()] if record.kept else [])])
        state = f'<strong class="old">old</strong>: {escaped(words)}' if words else "of the newest session"
        times = f"{record.first:%Y-%m-%d %H:%M:%S} to {record.last:%H:%M:%S} UTC"
        machine = f"{context.get('cpu_model', '')}, {context.get('num_cpus', '')} cores"
        rows.append([link(f"raw/{record.name}.json"), f"<code>{escaped(record.commit[:12])}</code>{' with uncommitted changes' if record.is_dirty else ''}", escaped(times), str(record.count), state,
                     escaped(machine), escaped(f"{context.get('compiler', '')} {context.get('compiler_flags', '')}")])
    newest = [[escaped(key), escaped(value_text(value))] for key, value in ages.newest.context.items()]
    body = [element("h2", "Environment"), scrolling(plain_table(["record", "commit", "measured", "repetitions", "age", "machine", "compiler"], rows), "Environment of each record", "lines"),
            f"<details><summary>All that {escaped(ages.newest.name)}, the newest, says of its machine</summary>{scrolling(plain_table(['what', 'value'], newest), 'Newest environment')}</details>",
            element("p", "Tables without a record in raw/ do not say which commit made them.", class_="note")]
    return element("section", "\n".join(body), id="environment")


def tables_section(results, ages):
    """Every table, with what is known of its age."""
    rows = []
    for name in results.names():
        is_old, text = ages.line(name)
        try:
            count = str(len(results.table(name)))
        except NotMeasured as reason:
            count = escaped(reason)
        rows.append([link(f"tables/{name}.csv"), count, escaped(text).replace("old", '<strong class="old">old</strong>', 1) if is_old else escaped(text), command(study_of(name), "")])
    return element("section", element("h2", "All tables") + scrolling(plain_table(["table", "rows", "age", "made by"], rows), "All tables"), id="all-tables")


def pictures_section(results):
    """Pictures of the physics, small enough to be in the page."""
    parts = []
    for name, text in PICTURES.items():
        path = results.directory / "figures" / name
        if path.exists():
            data = base64.b64encode(path.read_bytes()).decode("ascii")
            parts.append(f'<figure><img src="data:image/png;base64,{data}" alt="{escaped(text)}"><figcaption>{escaped(text)}: {link(f"figures/{name}")}, {escaped(pictures.made_by(path))}</figcaption></figure>')
    if not parts:
        parts = [element("p", "Not drawn: run <code>make reproduce</code>.", class_="missing")]
    made = ("Made by `dssbench run plate_paper --set n=60 --steps 2000 --output plate_paper.vtu`, `dssbench run l_bracket --output l_bracket.vtu --frames 6` and "
            "`plots/body_picture.py`.")
    return element("section", element("h2", "What is computed") + "\n".join(parts) + element("p", prose(made), class_="source"), id="pictures")


def safe_json(data):
    """JSON that cannot end the script that it stands in."""
    return json.dumps(data, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")


def assemble(origin, contents, body, charts, library):
    """The whole page. `library` is the text of plotly.min.js, or empty."""
    template = string.Template((HERE / "page.html").read_text(encoding="utf-8"))
    specs = {name: spec(chart) for name, chart in charts.items()} if library else {}
    listed = element("ul", "".join(element("li", element("a", escaped(title), href=f"#{name}")) for name, title in contents))
    return template.substitute(style=(HERE / "page.css").read_text(encoding="utf-8"), origin=origin, contents=listed, body="\n".join(body), charts=safe_json(specs),
                               library=library, script=(HERE / "page.js").read_text(encoding="utf-8"))
