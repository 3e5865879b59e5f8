"""The sections of the page."""
import base64
import json

from description import Filter
from pandas.api.types import is_numeric_dtype
from render import pictures
from tables.results import NotMeasured, study_of
from tables.words import (breakable, choice, escaped, is_missing, is_number, prose, shown,
                          with_interval)

from .elements import (OLD, age_text, code, command, details, element, elements, filters, link,
                       link_line, link_table, missing, plain_table, scrolling, source_line, table)
from .first_screen import first_screen

FIRST_PICTURE = {
    "arm.png": "The suspension arm of the scene arm/arm while its wheel runs over a bump"}
PICTURES = {
    "plate_paper.png": "The paper's plate, deformed, coloured by von Mises stress",
    "l_bracket.png": "The bracket of the scene l_bracket, deformed, coloured by von Mises stress",
    "l_bracket_frames.png": "The bracket over time"}
PICTURES_MADE_BY = (
    "Made by `dssbench run plate_paper --set n=60 --steps 2000 --output plate_paper.vtu`, "
    "`dssbench run l_bracket --output l_bracket.vtu --frames 6`, `dssbench run arm/arm --set "
    "duration=0.0035 --threads 2 --output arm.vtu` and `plots/body_picture.py`.")
OLD_MEANS = (
    "A record is called old if its commit, machine or compiler differs from that of the newest "
    "record, or if it is of an earlier session.")
ENDS = "_low", "_high"  # of the names of the columns of an interval
TALL = 15  # a table with more rows has a limited height


def summary_section(results, cards):
    """The first screen of the page."""
    return first_screen(results, cards, drawn(results, FIRST_PICTURE))


def chapter_head(chapter, answer):
    """The question of a chapter, and its answer."""
    return element("h2", escaped(chapter.question), id=chapter.name) + (
        element("p", prose(answer), class_="answer") if answer else "")


def old_and_missing_section(missing_sections, ages):
    """Missing sections with their reasons, old records, and tables of unknown age.

    missing_sections: (titles, reason, study)
    """
    lines = [f"{escaped(titles)}: {escaped(reason)}{f'; run {command(study)}' if study else ''}."
             for titles, reason, study in missing_sections]
    lines += [f"{escaped(name)} is {OLD}: {escaped(why)}." for name, why in ages.old()]
    if ages.unknown():
        names = ", ".join(link_table(name) for name in ages.unknown())
        lines.append(f"No record in raw/ says when these tables were made: {names}.")
    content = element("ul", elements("li", lines)) if lines else element("p", "Nothing.")
    content += element("p", OLD_MEANS, class_="note")
    return element("section", element("h2", "Old and missing") + content, id="old-and-missing")


def columns_of(chart):
    """(columns that differ from row to row, columns with one value), each with its heading."""
    differing, equal = {}, {}
    for column, heading in chart.columns.items():
        is_end = column.endswith(ENDS) and column.rsplit("_", 1)[0] in chart.columns
        if not is_end and column in chart.rows and chart.rows[column].notna().any():
            is_equal = len(chart.rows) > 1 and chart.rows[column].nunique(dropna=False) == 1
            (equal if is_equal else differing)[column] = heading
    return differing, equal


def value_of(row, column):
    """A value of a row, with its interval if the row has one."""
    low, high = (row.get(f"{column}{end}") for end in ENDS)
    return shown(row[column], 4) if is_missing(low) else with_interval(row[column], low, high)


def chart_table(chart):
    """The rows of a chart as a table, for screen readers and for those who want the numbers."""
    columns, equal = columns_of(chart)
    keys = [one.key for one in chart.filters if one.key in chart.rows]
    right = {column: "number" * is_numeric_dtype(chart.rows[column]) for column in columns}
    head = element("th", link_table(chart.table), scope="col") + "".join(
        element("th", escaped(heading), scope="col", class_=right[column])
        for column, heading in columns.items())
    lines = []
    for _, row in chart.rows.iterrows():
        cells = element("td", link_line(chart.table, row["line"])) + "".join(
            element("td", breakable(value_of(row, column)), class_=right[column])
            for column in columns)
        chosen = json.dumps({key: choice(row[key]) for key in keys})
        lines.append(element("tr", cells, data_keys=chosen, data_line=row["line"]))
    first = chart.rows.iloc[0]
    words = "; ".join(f"{heading}: {shown(first[column], 4)}" for column, heading in equal.items())
    note = element("p", f"In all rows: {escaped(words)}.", class_="note") if words else ""
    return note + scrolling(table(element("tr", head), lines), f"Rows of {chart.table}.csv")


def chart_section(entry, chart, age, made_by, has_library):
    """A chart with its words, filters and table. age: (is it old, text)"""
    picture = missing("Without Plotly there is no chart; its table is below.")
    if has_library:
        picture = element("div", "", class_="chart", role="img",
                          aria_label=f"{entry.title}. {chart.text}", data_chart=entry.name)
    choices = [(one, map(choice, chart.rows[one.key])) for one in chart.filters
               if one.key in chart.rows]
    body = [element("h3", escaped(entry.title)),
            element("p", age_text(*age), class_="age"),
            element("p", prose(chart.text)),
            filters(choices, entry.title),
            picture,
            details(f"As a table, {len(chart.rows)} rows", chart_table(chart)),
            source_line([f"tables/{chart.table}.csv"], made_by)]
    return element("section", "\n".join(body), class_="part", id=entry.name)


def missing_section(lack):
    """A section that cannot be shown, with the reason and the command that helps."""
    text = escaped(lack.reason[0].upper() + lack.reason[1:])
    if not lack.is_fault:
        text += f": run {command(study_of(lack.table))}"
    return element("section", element("h3", escaped(lack.title)) + missing(text), id=lack.name,
                   data_missing="yes")


def grid_head(grid):
    """Two lines of headings: the kinds of columns, and the columns."""
    above = "".join(element("th", escaped(heading), colspan=len(columns), scope="colgroup",
                            class_=f"{kind} first".strip())
                    for kind, heading, columns in grid.groups)
    names = [column for _, _, columns in grid.groups for column in columns]
    below = "".join(element("th", escaped(name), scope="col", class_=kind)
                    for name, kind in zip(names, grid_classes(grid)))
    return element("tr", above) + element("tr", below)


def grid_classes(grid):
    """The classes of each column: its kind, and whether it is the first of its group."""
    return [f"{kind}{' first' * (place == 0)}".strip()
            for kind, _, columns in grid.groups for place in range(len(columns))]


def grid_row(grid, number):
    """One row of a grid; its first cell is a heading."""
    cells = []
    for place, (cell, kind) in enumerate(zip(grid.rows[number], grid_classes(grid))):
        text = breakable(cell.text)
        if cell.table:
            text = element("a", text[text.rfind(":"):], href=f"{cell.table}.csv",
                           title=f"{cell.table}.csv:{cell.line}")
        tag, scope = ("td", "") if place else ("th", "row")
        is_right = place > 0 and is_number(cell.text)
        cells.append(element(tag, text, class_=f"{kind}{' number' * is_right}".strip(),
                             scope=scope))
    keys = {label: values[number] for label, values in grid.filters.items()}
    return element("tr", "".join(cells), data_keys=json.dumps(keys))


def grid_section(grid, age, made_by, folder=""):
    """One of Tables 1 to 3. age: (is it old, text); folder: of another machine's results"""
    count = len(grid.rows)
    content = table(grid_head(grid), (grid_row(grid, number) for number in range(count)))
    choices = [(Filter(label, label), values) for label, values in grid.filters.items()]
    body = [element("h3", escaped(grid.title)),
            element("p", age_text(*age), class_="age"),
            filters(choices, grid.title),
            scrolling(content, grid.title, "grid tall" if count > TALL else "grid"),
            *[element("p", prose(note), class_="note") for note in grid.notes],
            source_line([f"{folder}tables/{name}.csv" for name in grid.tables], code(made_by))]
    return element("section", "\n".join(body), class_="part", id=grid.name)


def value_text(value):
    """A value of a record's context; lists and objects are written in one line."""
    if isinstance(value, dict):
        return ", ".join(f"{name} {value_text(part)}" for name, part in value.items())
    if isinstance(value, list):
        return "; ".join(value_text(part) for part in value)
    return "" if is_missing(value) else str(value)


def record_cells(record):
    """A record in the table of environments."""
    context, changes = record.context, " with uncommitted changes" * record.is_dirty
    return [link(f"raw/{record.name}.json"),
            code(record.commit[:12]) + changes,
            escaped(f"{record.first:%Y-%m-%d %H:%M:%S} to {record.last:%H:%M:%S} UTC"),
            str(record.count),
            f"{OLD}: {escaped(record.why_old())}" if record.is_old() else "of the newest session",
            escaped(f"{context.get('cpu_model', '')}, {context.get('num_cpus', '')} cores"),
            escaped(f"{context.get('compiler', '')} {context.get('compiler_flags', '')}")]


def environment_section(ages):
    """What made each record, and everything that the newest record says of its machine."""
    heading = element("h2", "Environment")
    if not ages.records:
        return element("section", heading + missing("Not recorded: there is no raw/NAME.json."),
                       id="environment")
    headings = ["record", "commit", "measured", "repetitions", "age", "machine", "compiler"]
    rows = [record_cells(record) for record in ages.newest_first()]
    newest = plain_table(["key", "value"], [[escaped(key), escaped(value_text(value))]
                                            for key, value in ages.newest.context.items()])
    body = [heading,
            scrolling(plain_table(headings, rows), "Environment of each record", "lines"),
            details(f"Environment of the newest record, {escaped(ages.newest.name)}",
                    scrolling(newest, "Newest environment")),
            element("p", "Tables without a record in raw/ do not say which commit made them.",
                    class_="note")]
    return element("section", "\n".join(body), id="environment")


def count_text(results, name):
    """The number of rows of a table, or why they cannot be read."""
    try:
        return str(len(results.table(name)))
    except NotMeasured as reason:
        return escaped(reason)


def tables_section(results, ages):
    """Every table, with what is known of its age."""
    rows = [[link_table(name), count_text(results, name), age_text(*ages.line(name)),
             command(study_of(name))] for name in results.names()]
    listed = plain_table(["table", "rows", "age", "made by"], rows)
    return element("section", element("h2", "All tables") + scrolling(listed, "All tables"),
                   id="all-tables")


def picture_figure(path, text):
    """A picture of a body; the page carries its data."""
    data = base64.b64encode(path.read_bytes()).decode("ascii")
    caption = f"{escaped(text)}: {link(f'figures/{path.name}')}, {escaped(pictures.made_by(path))}"
    image = f'<img src="data:image/png;base64,{data}" alt="{escaped(text)}">'
    return element("figure", image + element("figcaption", caption))


def drawn(results, pictures_of):
    """Those of some pictures that are there."""
    paths = {results.directory / "figures" / name: text for name, text in pictures_of.items()}
    return [picture_figure(path, text) for path, text in paths.items() if path.exists()]


def pictures_section(results):
    """Pictures of deformed bodies, but for that of the summary."""
    parts = drawn(results, PICTURES)
    parts = parts or [missing("Not drawn: run <code>make reproduce</code>.")]
    return element("section", element("h2", "Pictures") + "\n".join(parts)
                   + element("p", prose(PICTURES_MADE_BY), class_="source"), id="pictures")
