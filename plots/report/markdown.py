"""REPORT.md: the summary, Tables 1 to 3, the figures, what is old and what is missing."""
from render import pictures


def cell_text(cell):
    text = cell.text.replace("|", "\\|")
    return f"[{text}]({cell.table}.csv)" if cell.table and text else text


def grid_lines(grid, age, made_by):
    heads = [f"{kind}: {column}" if kind else column for kind, _, columns in grid.groups for column in columns]
    lines = [f"### {grid.title}", "", age[1], "", "| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    lines += ["| " + " | ".join(cell_text(cell) for cell in row) + " |" for row in grid.rows]
    return [*lines, "", " ".join([*grid.notes, f"Made by `{made_by}`."]), ""]


def write(sentences, grids, figures, missing, ages):
    """The text of REPORT.md. grids: (grid, age, command); missing: (titles, reason, study)."""
    lines = ["# Report", "", "Made by `plots/make_report.py` from the tables beside it; [report.html](report.html), where it was built, has the charts.", ""]
    lines += [*[f"{number}. {text}" for number, text in enumerate(sentences, 1)], "", "## Old and missing", ""]
    lines += [f"* {titles}: {reason}{f'; run `dssbench experiment {study}`' if study else ''}." for titles, reason, study in missing] or ["Nothing is missing."]
    lines += [""] + ([f"* {name} is old: {why}." for name, why in ages.old()] or ["No record is known to be old."])
    if ages.unknown():
        names = ", ".join(f"[{name}](tables/{name}.csv)" for name in ages.unknown())
        lines.append(f"* No record in raw/ says when these tables were made: {names}.")
    lines += ["", "## Tables of the paper", ""]
    for grid, age, made_by in grids:
        lines += grid_lines(grid, age, made_by)
    lines += ["## Figures", "", *[f"* [{path.name}](figures/{path.name}), {pictures.made_by(path)}" for path in figures]]
    return "\n".join(lines) + "\n"
