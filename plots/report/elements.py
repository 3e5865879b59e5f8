"""Elements of HTML that several sections of the page use. They return text."""
from tables.words import escaped

OLD = '<strong class="old">old</strong>'
SEVERAL = "\n"  # separates the values of one choice; page.js splits at it


def element(tag, content, **attributes):
    """An element. `class_` gives `class`, `data_keys` gives `data-keys`.

    Attributes without a value are left out.
    """
    words = "".join(f' {name.rstrip("_").replace("_", "-")}="{escaped(value)}"'
                    for name, value in attributes.items() if value not in (None, ""))
    return f"<{tag}{words}>{content}</{tag}>"


def elements(tag, contents, **attributes):
    """Elements of one tag, one after the other."""
    return "".join(element(tag, content, **attributes) for content in contents)


def link(path, line=None):
    """A link to a file of the directory of results; a line of the file may be named."""
    return f'<a href="{escaped(path)}">{escaped(path)}{f":{line}" if line else ""}</a>'


def link_table(table, line=None):
    """A link to tables/TABLE.csv."""
    return link(f"tables/{table}.csv", line)


def link_line(table, line):
    """A link to tables/TABLE.csv that shows the line alone."""
    return element("a", f":{line}", href=f"tables/{table}.csv")


def code(text):
    """Text of a program."""
    return element("code", escaped(text))


def command_text(study, scale=""):
    """The command that makes the tables of a study."""
    return f"dssbench experiment {study}{f' --scale {scale}' if scale else ''}"


def command(study, scale=""):
    """The command that makes the tables of a study, as an element."""
    return code(command_text(study, scale))


def missing(text):
    """A paragraph that stands where something is missing. text: ready HTML"""
    return element("p", text, class_="missing")


def age_text(is_old, text):
    """A line on the age of a table; its first word `old` is marked if the table is old."""
    return escaped(text).replace("old", OLD, 1) if is_old else escaped(text)


def source_line(paths, made_by):
    """Where the data of a section are, and the element of the command that makes them."""
    sources = ", ".join(link(path) for path in paths)
    return element("p", f"From {sources}; made by {made_by}.", class_="source")


def scrolling(table, label, more=""):
    """A wide table scrolls by itself, with the keyboard too. more: further classes"""
    return element("div", table, class_=f"scroll {more}".strip(), tabindex="0", role="region",
                   aria_label=label)


def details(summary, content):
    """Content that is closed at first."""
    return f"<details><summary>{summary}</summary>{content}</details>"


def table(head, rows):
    """A table of rows of ready HTML."""
    return f"<table><thead>{head}</thead><tbody>{''.join(rows)}</tbody></table>"


def plain_table(headings, rows):
    """A table of headings and of rows of cells; the cells are ready HTML."""
    head = element("tr", elements("th", map(escaped, headings), scope="col"))
    return table(head, (element("tr", elements("td", cells)) for cells in rows))


def select(choice, values):
    """The list of one filter."""
    options = [] if choice.is_single else ['<option value="">all</option>']
    name, known = choice.first or choice.opens_with or ("", ())
    several = [value for value in known if value in values]
    if several:
        options.insert(0, element("option", escaped(name), value=SEVERAL.join(several),
                                  selected="selected"))
    options += [element("option", escaped(value), value=value) for value in values]
    content = element("select", "".join(options), name=choice.key)
    return f"<label>{escaped(choice.label)}{content}</label>"


def filters(choices, label):
    """The lists of all filters. choices: (Filter, values of all rows); one value needs no list"""
    unique = [(choice, list(dict.fromkeys(values))) for choice, values in choices]
    lists = [select(choice, values) for choice, values in unique if len(values) > 1]
    if not lists:
        return ""
    return element("div", "".join(lists) + "<output></output>", class_="filters", role="group",
                   aria_label=f"Filters: {label}")
