"""REPORT.md: the summary, Tables 1 to 3, the figures, and what is old or missing."""
from render import pictures

HEADING = """# Report

Made by `plots/make_report.py` from the tables beside it. The charts are in \
[report.html](report.html), where it was built.
"""


def cell_text(cell):
    """A cell of a grid, with a link to the table it is from."""
    text = cell.text.replace("|", "\\|")
    return f"[{text}]({cell.table}.csv)" if cell.table and text else text


def grid_lines(grid, age, made_by):
    """A grid as a table of Markdown, with its age and its notes."""
    heads = [f"{heading}: {column}" if heading else column
             for _, heading, columns in grid.groups for column in columns]
    lines = [f"### {grid.title}", "", age[1], "",
             "| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    lines += ["| " + " | ".join(cell_text(cell) for cell in row) + " |" for row in grid.rows]
    return [*lines, "", " ".join([*grid.notes, f"Made by `{made_by}`."]), ""]


def missing_lines(missing):
    """A line for each reason why sections are missing. missing: (titles, reason, study)"""
    if not missing:
        return ["Nothing is missing."]
    return [f"* {titles}: {reason}{f'; run `dssbench experiment {study}`' if study else ''}."
            for titles, reason, study in missing]


def age_lines(ages):
    """A line for each old record, and one for the tables without a record."""
    lines = [f"* {name} is old: {why}." for name, why in ages.old()]
    lines = lines or ["No record is known to be old."]
    if ages.unknown():
        names = ", ".join(f"[{name}](tables/{name}.csv)" for name in ages.unknown())
        lines.append(f"* No record in raw/ says when these tables were made: {names}.")
    return lines


def write(sentences, grids, figures, missing, ages):
    """The text of REPORT.md. grids: (grid, age, command); missing: (titles, reason, study)."""
    lines = [HEADING, *[f"{number}. {text}" for number, text in enumerate(sentences, 1)], "",
             "## Tables of the paper", ""]
    for grid, age, made_by in grids:
        lines += grid_lines(grid, age, made_by)
    lines += ["## Figures", ""]
    lines += [f"* [{path.name}](figures/{path.name}), {pictures.made_by(path)}"
              for path in figures]
    lines += ["", "## Old and missing", "", *missing_lines(missing), "", *age_lines(ages)]
    return "\n".join(lines) + "\n"
