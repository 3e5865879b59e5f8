#!/usr/bin/python3
"""The report of a directory of results: report.html, one page that opens from disk without a network, and REPORT.md.

Reads DIR/tables, DIR/raw and DIR/figures, and nothing else. Plotly, which draws the page's charts, is installed into --environment by pip once; where that fails, the
page has the tables alone, and one line says so.
Example: plots/make_report.py --results results
"""
import argparse
import pathlib
import re
import sys

from charts import CHARTS
from render.pictures import revision
from report import library, markdown, page, paper_tables, summary
from tables.age import Ages
from tables.results import FAULTS, ROOT, Lack, NotMeasured, Results, study_of
from tables.words import escaped, prose

MOST_BYTES = 10_000_000


def scale_of(results, ages, table):
    """The scale of a table, from its rows or its record."""
    try:
        scales = results.table(table, "scale")["scale"].dropna()
        return str(scales.iloc[0]) if len(scales) else ""
    except NotMeasured:
        return ages.records[study_of(table)].scale if study_of(table) in ages.records else ""


def command_text(results, ages, table):
    """As page.command says it, without marks."""
    return re.sub("<[^>]*>", "", page.command(study_of(table), scale_of(results, ages, table)))


def attempt(missing, name, title, table, make):
    """What `make` gives; else it is missing, and none."""
    try:
        return make()
    except NotMeasured as reason:
        missing.append(Lack(name, title, table, str(reason)))
    except FAULTS as fault:  # one odd table takes no page from the others
        missing.append(Lack(name, title, table, f"tables/{table}.csv cannot be drawn: {type(fault).__name__}: {fault}", is_fault=True))
    return None


def other_grids(results, missing):
    """(grid, age, command, folder) of Table 3 on other machines."""
    for other in results.others():
        ages, folder = Ages(other.directory), other.directory.name
        grid = attempt(missing, f"table-3-{folder}", f"Table 3 of {folder}", "table3", lambda: paper_tables.other_table3(other))
        if grid:
            yield grid, ages.line("table3"), command_text(other, ages, "table3"), f"{folder}/"


def origin_text(results, ages):
    parts = [f"Results in <code>{escaped(results.directory.name)}</code>, {len(results.names())} tables"]
    if ages.newest:
        parts.append(f"newest record {escaped(ages.newest.name)}, {escaped(ages.newest.made_by(ages.newest.last))}")
    if revision():
        parts.append(f"this page by commit {revision()}")
    return "; ".join(parts) + "."


def by_study(missing):
    """(titles, reason, study) of sections that one study would fill; no study if its tables are there."""
    groups = {}
    for lack in missing:
        groups.setdefault((lack.reason, "" if lack.is_fault else study_of(lack.table)), []).append(lack.title)
    return [("; ".join(titles), reason, study) for (reason, study), titles in groups.items()]


def old_and_missing(missing, ages):
    """The section that says both."""
    lines = [f"{escaped(titles)}: {escaped(reason)}{f'; run {page.command(study, str())}' if study else ''}." for titles, reason, study in by_study(missing)]
    lines += [f'{escaped(name)} is <strong class="old">old</strong>: {escaped(why)}.' for name, why in ages.old()]
    if ages.unknown():
        lines.append(f'No record in raw/ says when these tables were made: {", ".join(page.link(f"tables/{name}.csv") for name in ages.unknown())}.')
    content = page.element("ul", "".join(page.element("li", line) for line in lines)) if lines else page.element("p", "Nothing.")
    return page.element("section", page.element("h2", "Old and missing") + content, id="old-and-missing")


def chart_of(results, ages, plotly, entry):
    """A chart and its section."""
    chart = entry.make(results)
    return chart, page.chart_section(entry.name, entry.title, chart, ages.line(entry.table),
                                     scale_of(results, ages, entry.table), bool(plotly))


def build(results, plotly):
    """(text of the page, text of REPORT.md, what is missing)."""
    ages, missing, charts, sections = Ages(results.directory), [], {}, []
    grids = [(grid, ages.line(table), command_text(results, ages, table), "")
             for name, title, table, make in paper_tables.TABLES if (grid := attempt(missing, name, title, table, lambda: make(results)))]
    grids += other_grids(results, missing)
    for entry in CHARTS:
        drawn = attempt(missing, entry.name, entry.title, entry.table, lambda: chart_of(results, ages, plotly, entry))
        if drawn:
            charts[entry.name] = drawn[0]
        sections.append(drawn[1] if drawn else page.missing_section(missing[-1]))
    drawn_later = {entry.name for entry in CHARTS}
    sentences = summary.sentences(results, missing, ages)
    body = [page.element("section", page.element("h2", "Summary") + page.element("ol", "".join(page.element("li", prose(text)) for text in sentences), class_="summary"), id="summary"),
            old_and_missing(missing, ages), page.element("h2", "Tables of the paper", id="tables")]
    body += [page.grid_section(grid, age, page.element("code", escaped(made_by)), folder) for grid, age, made_by, folder in grids]
    body += [page.missing_section(lack) for lack in missing if lack.name not in drawn_later]
    body += [page.element("h2", "Charts", id="charts-of-studies"), *sections, page.pictures_section(results), page.environment_section(ages), page.tables_section(results, ages)]
    contents = [("summary", "Summary"), ("old-and-missing", "Old and missing"), ("tables", "Tables 1-3")] + [(entry.name, entry.title) for entry in CHARTS]
    contents += [("pictures", "Pictures"), ("environment", "Environment"), ("all-tables", "All tables")]
    text = markdown.write(sentences, [grid[:3] for grid in grids], results.figures(), by_study(missing), ages)
    return page.assemble(origin_text(results, ages), contents, body, charts, plotly), text, missing


def plotly_text(environment):
    """plotly.min.js; an empty text if it cannot be had, which one line says."""
    path, reason = library.installed(environment), ""
    if path is None:
        path, reason = library.install(environment)
    if path is None:
        print(f"report.html gets no charts: Plotly cannot be installed ({reason})", file=sys.stderr)
        return ""
    return path.read_text(encoding="utf-8").replace("</script", "<\\/script")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--results", type=pathlib.Path, default=pathlib.Path("results"), help="directory with tables/, raw/ and figures/")
    parser.add_argument("--environment", type=pathlib.Path, default=ROOT / "build" / "report-environment", help="virtual environment for Plotly")
    arguments = parser.parse_args()
    results = Results(arguments.results.resolve())
    if not results.names():
        sys.exit(f"{arguments.results}: no tables/*.csv; run `dssbench experiment` first")
    html, text, missing = build(results, plotly_text(arguments.environment))
    size = len(html.encode("utf-8"))
    if size > MOST_BYTES:
        sys.exit(f"{arguments.results}/report.html would have {size / 1e6:.1f} MB; at most {MOST_BYTES / 1e6:.0f} MB are allowed: thin out what plots/charts draws")
    for name, content in (("report.html", html), ("REPORT.md", text)):
        unfinished = results.directory / f".{name}.new"
        unfinished.write_text(content, encoding="utf-8")
        unfinished.replace(results.directory / name)
    print(f"{arguments.results / 'report.html'} ({size / 1e6:.1f} MB)\n{arguments.results / 'REPORT.md'}")
    if any(lack.is_fault for lack in missing):
        sys.exit("\n".join(f"{lack.title}: {lack.reason}" for lack in missing if lack.is_fault))


if __name__ == "__main__":
    main()
