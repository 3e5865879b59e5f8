#!/usr/bin/python3
"""Writes the report of a directory of results: report.html and REPORT.md.

report.html is one page that opens from disk and needs no network. The command reads DIR/tables,
DIR/raw and DIR/figures. pip installs Plotly, which draws the charts of the page, into
--environment once. If that fails, one line says so, and the page has the tables alone.
Example: plots/make_report.py --results results
"""
import argparse
import pathlib
import sys

from render.pictures import revision
from report import elements, library, markdown, page, paper_tables, sections, story, summary
from tables.age import Ages
from tables.results import FAULTS, ROOT, Lack, NotMeasured, Results, study_of
from tables.words import escaped

MOST_BYTES = 10_000_000


def scale_of(results, ages, table):
    """The scale of a table, from its rows or its record."""
    try:
        scales = results.table(table, "scale")["scale"].dropna()
        return str(scales.iloc[0]) if len(scales) else ""
    except NotMeasured:
        record = ages.records.get(study_of(table))
        return record.scale if record else ""


def command_of(results, ages, table):
    """The command that makes a table at its scale."""
    return elements.command_text(study_of(table), scale_of(results, ages, table))


def attempt(missing, name, title, table, make):
    """The result of `make`. If it fails, `missing` gets the reason, and the result is None."""
    try:
        return make()
    except NotMeasured as reason:
        missing.append(Lack(name, title, table, str(reason)))
    except FAULTS as fault:  # a table with odd values must not stop the others
        text = f"tables/{table}.csv cannot be drawn: {type(fault).__name__}: {fault}"
        missing.append(Lack(name, title, table, text, is_fault=True))
    return None


def grids_of(results, ages, missing):
    """(grid, age, command, folder) of Tables 1 to 3, and of Table 3 on other machines."""
    found = []
    for name, title, table, make in paper_tables.TABLES:
        if not results.expects(table):
            continue
        grid = attempt(missing, name, title, table, lambda: make(results))
        if grid:
            found.append((grid, ages.line(table), command_of(results, ages, table), ""))
    for other in results.others():
        own, folder = Ages(other.directory), other.directory.name
        grid = attempt(missing, f"table-3-{folder}", f"Table 3 of {folder}", "table3",
                       lambda: paper_tables.other_table3(other))
        if grid:
            found.append((grid, own.line("table3"), command_of(other, own, "table3"),
                          f"{folder}/"))
    return found


def origin_text(results, ages):
    """What the page was made of, and by which commit."""
    parts = [f"Results in <code>{escaped(results.directory.name)}</code>, "
             f"{len(results.names())} tables"]
    if ages.newest:
        made_by = ages.newest.made_by(ages.newest.last)
        parts.append(f"newest record {escaped(ages.newest.name)}, {escaped(made_by)}")
    if revision():
        parts.append(f"this page by commit {revision()}")
    return "; ".join(parts) + "."


def by_study(missing):
    """(titles, reason, study) of missing sections that one study would fill.

    The study is empty if its tables are there and cannot be drawn.
    """
    groups = {}
    for lack in missing:
        study = "" if lack.is_fault else study_of(lack.table)
        groups.setdefault((lack.reason, study), []).append(lack.title)
    return [("; ".join(titles), reason, study) for (reason, study), titles in groups.items()]


def chapter_of(results, ages, missing, entries, has_library):
    """(charts by name, sections in order) of the charts of one chapter."""
    charts, found = {}, []
    for entry in entries:
        def make(entry=entry):
            chart = entry.make(results)
            made_by = elements.code(command_of(results, ages, entry.table))
            return chart, sections.chart_section(entry, chart, ages.line(entry.table), made_by,
                                                 has_library)
        made = attempt(missing, entry.name, entry.title, entry.table, make)
        if made:
            charts[entry.name] = made[0]
        found.append(made[1] if made else sections.missing_section(missing[-1]))
    return charts, found


def own_chapter_of(results, ages, missing, entries, has_library):
    """The same of studies of a user's own, of which one need not have every kind of chart."""
    lacking = []
    charts, found = chapter_of(results, ages, lacking, entries, has_library)
    faults = [lack for lack in lacking if lack.is_fault]
    missing += faults
    names = [*charts, *(lack.name for lack in faults)]
    parts = [part for entry, part in zip(entries, found) if entry.name in names]
    return charts, parts or [elements.missing("No chart can be drawn of these tables.")]


def story_of(results, ages, chapters, grids, missing, has_library):
    """(charts by name, parts of the body, contents) of all chapters."""
    charts, body, contents = {}, [], []
    for chapter, entries in chapters:
        make = own_chapter_of if chapter is story.OWN else chapter_of
        first, parts = [], []
        if chapter.name == story.TABLES:
            first = [(grid[0].name, grid[0].title) for grid in grids]
            parts = [sections.grid_section(*grid) for grid in grids]
            parts += map(sections.missing_section, missing)
        drawn, more = make(results, ages, missing, entries, has_library)
        charts.update(drawn)
        body += [sections.chapter_head(chapter, story.answer_of(chapter, results, drawn)),
                 *parts, *more]
        shown = [entry for entry in entries if chapter is not story.OWN or entry.name in drawn]
        contents.append((chapter.name, chapter.question,
                         [*first, *((entry.name, entry.title) for entry in shown)]))
    return charts, body, contents


def build(results, plotly):
    """(text of the page, text of REPORT.md, what is missing)."""
    ages, missing = Ages(results.directory), []
    chapters = story.entries_of(results)
    has_story = any(chapter is not story.OWN for chapter, _ in chapters)
    grids = grids_of(results, ages, missing) if has_story else []
    charts, parts, contents = story_of(results, ages, chapters, grids, missing, bool(plotly))
    cards, groups = summary.cards(results, missing, ages) if has_story else [], by_study(missing)
    body = [sections.summary_section(results, cards), *parts,
            sections.pictures_section(results),
            sections.old_and_missing_section(groups, ages),
            sections.environment_section(ages),
            sections.tables_section(results, ages)]
    contents += [("pictures", "Pictures", []), ("old-and-missing", "Old and missing", []),
                 ("environment", "Environment", []), ("all-tables", "All tables", [])]
    text = markdown.write([card.text for card in cards], [grid[:3] for grid in grids],
                          results.figures(), groups, ages)
    return page.assemble(origin_text(results, ages), contents, body, charts, plotly), text, missing


def plotly_text(environment):
    """The text of plotly.min.js; empty, with a line that says so, if it cannot be installed."""
    path, reason = library.installed(environment), ""
    if path is None:
        path, reason = library.install(environment)
    if path is None:
        print(f"report.html gets no charts: Plotly cannot be installed ({reason})",
              file=sys.stderr)
        return ""
    return path.read_text(encoding="utf-8").replace("</script", "<\\/script")


def read_arguments():
    """The options of the command."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--results", type=pathlib.Path, default=pathlib.Path("results"),
                        help="directory with tables/, raw/ and figures/")
    parser.add_argument("--environment", type=pathlib.Path,
                        default=ROOT / "build" / "report-environment",
                        help="virtual environment for Plotly")
    return parser.parse_args()


def main():
    """The command."""
    arguments = read_arguments()
    results = Results(arguments.results.resolve())
    if not results.names():
        sys.exit(f"{arguments.results}: no tables/*.csv; run `dssbench experiment` first")
    html, text, missing = build(results, plotly_text(arguments.environment))
    size = len(html.encode("utf-8"))
    if size > MOST_BYTES:
        sys.exit(f"{arguments.results}/report.html would have {size / 1e6:.1f} MB; at most "
                 f"{MOST_BYTES / 1e6:.0f} MB are allowed: draw fewer points in plots/charts")
    for name, content in (("report.html", html), ("REPORT.md", text)):
        unfinished = results.directory / f".{name}.new"
        unfinished.write_text(content, encoding="utf-8")
        unfinished.replace(results.directory / name)
    print(f"{arguments.results / 'report.html'} ({size / 1e6:.1f} MB)\n"
          f"{arguments.results / 'REPORT.md'}")
    faults = [f"{lack.title}: {lack.reason}" for lack in missing if lack.is_fault]
    if faults:
        sys.exit("\n".join(faults))


if __name__ == "__main__":
    main()
