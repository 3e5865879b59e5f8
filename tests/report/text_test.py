"""Tests the words of the report without a browser, and the claims of ARTIFACT.md."""
import csv
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import report
import sample

try:
    import pandas
    from matplotlib.figure import Figure
except ImportError as missing:
    report.skip_all(f"this python has no {missing.name}")
sys.path.insert(0, str(report.ROOT / "plots"))
import body_picture  # noqa: E402
from charts import CHARTS  # noqa: E402
from tables import age, words  # noqa: E402
from tables.results import ON_DEMAND  # noqa: E402


def read(path):
    """The text of a file."""
    return path.read_text(encoding="utf-8")


def section(page, name):
    """The text of one section of a page."""
    return page.split(f'id="{name}"')[1].split("</section>")[0]


class ReportTest(unittest.TestCase):
    """Reports of the sample and of the committed results."""

    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory(prefix="dssbench-report-")
        cls.addClassCleanup(holder.cleanup)
        cls.directory = pathlib.Path(holder.name)
        sample.write_sample(cls.directory / "sample")
        report.copy_committed(cls.directory / "committed")
        (cls.directory / "no-directory").write_text("", encoding="utf-8")
        cls.pages = {}
        for name in ("sample", "committed"):
            result = cls.make_report(name)
            if result.returncode:
                raise AssertionError(result.stderr)
            cls.said = result.stderr
            cls.pages[name] = read(cls.directory / name / "report.html")

    @classmethod
    def make_report(cls, name):
        """Makes a report without Plotly: its environment cannot be made, as without a network."""
        return report.make_report(cls.directory / name,
                                  cls.directory / "no-directory" / "environment")

    def section(self, name, of="sample"):
        """One section of a page."""
        return section(self.pages[of], name)

    def test_without_plotly_one_line_says_so_and_the_tables_are_there(self):
        self.assertEqual(self.said.count("\n"), 1, self.said)
        self.assertIn("Plotly cannot be installed", self.said)
        self.assertIn("table1_host.csv:4", self.pages["sample"])
        self.assertNotIn('class="chart"', self.pages["sample"])

    def test_the_summary_has_the_figures_of_the_tables(self):
        path = self.directory / "committed" / "tables" / "table1.csv"
        with open(path, encoding="utf-8") as file:
            rows = [row for row in csv.DictReader(file)
                    if row["source"] == "measured" and row["status"] == "ok"]

        def speedup(row, base):
            return float(row.get(f"speedup_vs_{base}")
                         or row.get(f"extrapolated_speedup_vs_{base}") or 0)

        best = max(rows, key=lambda row: speedup(row, "scalar"))
        for base in ("as_published", "reference", "scalar"):
            self.assertIn(f"{speedup(best, base):.3g} [", self.section("summary", "committed"))
        summary = self.section("summary")
        self.assertIn(">16 times<", summary)
        self.assertIn("1 of 3 cells of the failure atlas", summary)
        # The last stage is faster, but its error is too large.
        self.assertIn(">1,024 [", summary)
        self.assertIn("Model, method and precision chosen, up to the stage: f32.", summary)
        self.assertIn("8.9e-5 is allowed", summary)
        self.assertIn("The fastest stage within the allowed error is 1,024 times as_published "
                      "(f32)", self.section("chain"))

    def test_what_is_missing_is_said_with_the_command(self):
        for study in ("work_precision", "stability", "table2", "cluster"):
            self.assertIn(f"Not measured: run <code>dssbench experiment {study}</code>",
                          self.pages["sample"])
        self.assertIn("tables/advise.csv is of another version", self.pages["sample"])
        self.assertIn("tables/statics.csv has no rows", self.pages["sample"])

    def test_a_study_that_no_reproduction_measures_is_not_missing(self):
        self.assertIn('id="table-1-host"', self.pages["sample"])
        self.assertNotIn('id="table-1-host"', self.pages["committed"])
        self.assertNotIn("experiment table1_host", self.pages["committed"])
        makefile = read(report.ROOT / "Makefile")
        for study in ON_DEMAND:
            self.assertNotIn(study, makefile)

    def test_every_chart_is_in_one_chapter_and_each_chapter_answers_its_question(self):
        for name, page in self.pages.items():
            for entry in CHARTS:
                if entry.table not in ON_DEMAND or name == "sample":
                    self.assertEqual(page.count(f' id="{entry.name}"'), 1, entry.name)
        questions = re.findall(r'<h2 id="[^"]*">[^<]*\?</h2>(.*)', self.pages["committed"])
        self.assertEqual(len(questions), 7)
        for after in questions:
            self.assertRegex(after, r'^<p class="answer">.*\d')

    def test_a_study_of_ones_own_is_a_chapter_and_nothing_else_is_missing(self):
        directory = self.directory / "own"
        report.copy_committed(directory)
        for path in (directory / "tables").iterdir():
            if path.name != "table1.csv":
                path.unlink()
        (directory / "tables" / "table1.csv").rename(directory / "tables" / "mine.csv")
        shutil.rmtree(directory / "raw")
        result = self.make_report("own")
        self.assertEqual(result.returncode, 0, result.stderr)
        page = read(directory / "report.html")
        self.assertIn('<h2 id="own">Studies of your own</h2>', page)
        self.assertIn("<h3>mine: speed-ups</h3>", page)
        self.assertIn("<h3>mine: scaling over ranks</h3>", page)
        self.assertNotIn("mine: error against time", page)
        self.assertEqual(report.make_plots(directory).returncode, 0)
        self.assertNotIn("data-missing", page)
        self.assertNotIn("not measured", page)

    def test_numbers_are_written_for_people(self):
        for value, text in ((1751, "1,751"), (0.5, "0.5"), (8.47e-5, "8.47e-5"), (1e6, "1 M"),
                            (69.94e9, "69.9 G"), (999.99e6, "1 G"), (12345.6, "12,346"),
                            (-2e-12, "-2e-12"), (999.7, "1,000"), (1e15, "1e15"),
                            (-2e300, "-2e300"),
                            (float("nan"), ""), ("as it is", "as it is")):
            self.assertEqual(words.shown(value), text)
        self.assertEqual((words.shown(123.4, 2), words.shown(999600, 4)), ("120", "999,600"))
        for text in ("1,751", "~ 92 [88, 94]", "68.7 M", "-2e-12", "97 %"):
            self.assertTrue(words.is_number(text), text)
        for text in ("", "2 threads", "n=300", "as it is"):
            self.assertFalse(words.is_number(text), text)

    def test_columns_of_the_papers_tables_have_names_of_their_own(self):
        lines = read(self.directory / "committed" / "REPORT.md").splitlines()
        heads = [line.strip("| ").split(" | ") for line, after in zip(lines, lines[1:])
                 if after.startswith("|---")]
        self.assertGreaterEqual(len(heads), 4)
        for names in heads:
            self.assertEqual(len(set(names)), len(names), names)

    def test_old_records_are_named_with_their_date_and_reason(self):
        self.assertIn('<strong class="old">old</strong>: of 2029-12-30 12:00 UTC; made by commit '
                      "000000000", self.section("roofline"))
        self.assertIn("of an earlier session", self.section("atlas"))
        self.assertIn("4 of 7 records are", self.section("chain"))
        self.assertIn("kept by --resume", self.section("chain"))
        self.assertNotIn("old", self.section("table-1-host")[:400])

    def test_a_study_that_a_reproduction_measures_in_parts_is_not_old(self):
        times = [pandas.Timestamp("2030-01-01T12:00Z") + pandas.Timedelta(minutes=minutes)
                 for minutes in (0, 1, 20, 21, 40)]
        parts = [times[2] - pandas.Timedelta(seconds=5), times[4] - pandas.Timedelta(seconds=5)]
        self.assertEqual(age.kept_of(times, parts, 1), 4)
        self.assertEqual(age.kept_of(times, parts, 1, age.SESSION_GAP), 0)
        times[4] += pandas.Timedelta(hours=3)
        self.assertEqual(age.kept_of(times, [parts[0], times[4] - pandas.Timedelta(seconds=5)], 1,
                                     age.SESSION_GAP), 4)

    def test_a_table_without_a_record_is_of_unknown_age_whatever_the_time_of_its_file(self):
        directory = self.directory / "unrecorded"
        sample.write_sample(directory)
        os.utime(directory / "tables" / "advise.csv", (0, 0))
        os.utime(directory / "tables" / "statics.csv", (2e9, 2e9))
        self.assertEqual(self.make_report("unrecorded").returncode, 0)
        page, text = (read(directory / name) for name in ("report.html", "REPORT.md"))
        for study in ("advise", "statics"):
            self.assertIn(f"age unknown: no raw/{study}.json says which commit made it",
                          section(page, "all-tables"))
        first = page.split('id="tables"')[0] + section(page, "old-and-missing")
        for written in (first, text):
            self.assertIn("3 of 6 records are old, wholly or in part, and 2 tables have no record",
                          written)
            self.assertRegex(written, "No record in raw/ says when these tables were made: "
                                      ".*advise.*statics")

    def test_every_record_is_in_the_environment_with_its_commit(self):
        environment = self.section("environment", "committed")
        for path in (self.directory / "committed" / "raw").glob("*.json"):
            context = json.loads(read(path)).get("context")
            if context:
                self.assertIn(context["git_commit"][:12], environment)
        self.assertIn("A &lt;processor&gt;", self.pages["sample"])

    def test_every_line_that_is_shown_is_a_line_of_its_table(self):
        for name, page in self.pages.items():
            shown = set(re.findall(r'href="((?:\w+/)?tables/\w+\.csv)">[^<]*:(\d+)<', page))
            self.assertGreater(len(shown), 10)
            for path, line in shown:
                lines = read(self.directory / name / path).count("\n")
                self.assertTrue(2 <= int(line) <= lines, (name, path, line))

    def test_a_row_names_the_line_that_it_is_from(self):
        table = self.directory / "committed" / "tables" / "table3.csv"
        lines = read(table).splitlines()
        head = lines[0].split(",")
        found = re.findall(r'<th[^>]*scope="row">([^<]*)</th>.*?"tables/table3\.csv:(\d+)">',
                           self.section("table-3-executors", "committed"))
        self.assertGreater(len(found), 5)
        for label, line in found:
            row = next(csv.reader([lines[int(line) - 1]]))
            self.assertEqual(label, row[head.index("label")])

    def test_the_kinds_of_figures_stand_in_columns_of_their_own(self):
        for name in ("table-1", "table-2"):
            text = self.section(name, "committed")
            for kind in ("paper", "measured", "simulated"):
                self.assertRegex(text, rf'<th colspan="\d" scope="colgroup" class="{kind} first">')
                self.assertRegex(text, rf'<td class="{kind}[^"]*">[^<]*\d')

    def test_the_markdown_has_the_same_summary_and_links_that_lead_somewhere(self):
        directory = self.directory / "committed"
        text = read(directory / "REPORT.md")
        self.assertRegex(text, r"(?m)^3\. ")
        links = re.findall(r"\]\(([^)]+)\)", text)
        self.assertGreater(len(links), 50)
        for link in set(links) - {"report.html"}:
            self.assertTrue((directory / link).exists(), link)

    def odd_page(self, name, table, columns):
        """(result, page) of the sample in which columns of a table have no value."""
        directory = self.directory / name
        sample.write_sample(directory)
        with open(directory / "tables" / f"{table}.csv", encoding="utf-8") as file:
            rows = [{**row, **dict.fromkeys(columns, "")} for row in csv.DictReader(file)]
        sample.write_table(directory, table, ",".join(rows[0]), rows)
        return self.make_report(name), read(directory / "report.html")

    def test_one_odd_table_leaves_the_other_sections_and_ends_with_an_error(self):
        result, page = self.odd_page("odd", "kernels", ["kernel"])
        self.assertEqual(result.returncode, 1)
        fault = "Roofline: tables/kernels.csv cannot be drawn"
        self.assertIn(f"{fault}: KeyError: ", result.stderr)
        self.assertNotIn("Traceback", result.stderr)
        self.assertIn("Tables/kernels.csv cannot be drawn: KeyError: nan</p>", page)
        self.assertIn("1 section cannot be drawn", page)
        self.assertIn("<details><summary>As a table", section(page, "chain"))
        self.assertIn(fault, read(self.directory / "odd" / "REPORT.md"))

    def test_columns_that_are_empty_in_every_row_may_be_left_out(self):
        directory = self.directory / "reduced"
        report.copy_committed(directory)
        report.leave_out_empty_columns(directory)
        self.assertEqual(self.make_report("reduced").returncode, 0)
        self.assertEqual(read(directory / "REPORT.md"),
                         read(self.directory / "committed" / "REPORT.md"))

    def test_a_column_without_a_value_is_left_out_of_the_words(self):
        result, page = self.odd_page("blank", "kernels", ["limiter"])
        self.assertEqual(result.returncode, 0, result.stderr)
        roofline = section(page, "roofline")
        self.assertRegex(roofline, r"Closest to its roof is [^:]*: \d+ %\.")
        self.assertNotIn("nan", roofline)

    def test_a_directory_that_is_no_virtual_environment_is_left_as_it_is(self):
        environment = self.directory / "thesis"
        environment.mkdir()
        (environment / "chapter.tex").write_text("years of work", encoding="utf-8")
        result = report.make_report(self.directory / "sample", environment)
        self.assertEqual([path.name for path in environment.iterdir()], ["chapter.tex"])
        self.assertIn("neither empty nor a virtual environment", result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1)

    def test_pictures_say_what_made_them_or_that_their_age_is_unknown(self):
        directory = self.directory / "pictures"
        sample.write_sample(directory)
        result = report.make_plots(directory)
        self.assertEqual(result.returncode, 0, result.stderr)
        body_picture.write(Figure(), directory / "figures" / "l_bracket.png")
        Figure().savefig(directory / "figures" / "plate_paper.png")  # as another program would
        self.assertEqual(self.make_report("pictures").returncode, 0)
        shown = section(read(directory / "report.html"), "pictures")
        self.assertIn("(figures/failures.png), measured by commit 111111111, 2030-01-01 12:00 UTC",
                      read(directory / "REPORT.md"))
        self.assertRegex(shown, "figures/plate_paper.png</a>, age unknown</figcaption>")
        self.assertRegex(shown, r"figures/l_bracket.png</a>, drawn by commit \w+, "
                                r"\d{4}-\d\d-\d\d \d\d:\d\d UTC</figcaption>")

    def test_no_results_are_an_error_in_one_line(self):
        os.makedirs(self.directory / "empty", exist_ok=True)
        result = report.make_report(self.directory / "empty")
        self.assertEqual(result.returncode, 1)
        self.assertEqual(result.stderr.count("\n"), 1)
        self.assertIn("no tables", result.stderr)


class Continuous(unittest.TestCase):
    """The export for services that follow benchmarks."""

    def exported(self, *options):
        script = report.ROOT / "plots" / "continuous.py"
        return subprocess.run([sys.executable, script, *options], capture_output=True, text=True,
                              check=False)

    def test_times_have_unique_names_and_intervals(self):
        result = self.exported("--results", report.ROOT / "results")
        entries = json.loads(result.stdout)
        self.assertGreater(len(entries), 10)
        self.assertEqual(len({entry["name"] for entry in entries}), len(entries))
        for entry in entries:
            low, high = map(float, entry["range"].split(" to "))
            self.assertLessEqual(low, entry["value"] * 1.00001)
            self.assertGreaterEqual(high, entry["value"] * 0.99999)
            self.assertNotIn("nan", entry["name"])

    def test_a_table_of_something_else_is_an_error_in_one_line(self):
        for table in ("continuum", "no_table"):
            result = self.exported("--results", report.ROOT / "results", "--table", table)
            self.assertEqual((result.returncode, result.stdout), (1, ""))
            self.assertEqual(result.stderr.count("\n"), 1)


class Documents(unittest.TestCase):
    """The documents at the root."""

    def test_no_figure_waits_to_be_filled_in(self):
        for name in ("README.md", "ARTIFACT.md", "HACKING.md"):
            waiting = re.findall(r"\b(?:CHAIN|ATTR)_[A-Z0-9]+\b", read(report.ROOT / name))
            self.assertEqual(waiting, [], name)


class Artifact(unittest.TestCase):
    """ARTIFACT.md names commands and files that exist."""

    def setUp(self):
        self.text = read(report.ROOT / "ARTIFACT.md")

    def test_its_studies_exist(self):
        studies = re.findall(r"dssbench experiment (\w+)", self.text)
        self.assertGreater(len(studies), 5)
        for study in studies:
            found = list((report.ROOT / "experiments" / "studies").glob(f"*/{study}.json"))
            self.assertTrue(found, study)

    def test_its_scenes_exist(self):
        commands = "run|verify|advise|explain|stability|simulate"
        scenes = re.findall(rf"dssbench (?:{commands}) (?!-)(\w+)", self.text)
        self.assertTrue(scenes)
        for scene in scenes:
            path = report.ROOT / "experiments" / "scenes" / f"{scene}.json"
            self.assertTrue(path.exists(), scene)

    def test_its_tables_are_committed_and_have_the_columns(self):
        named = re.findall(r"`((?:h100/)?tables/\w+\.csv)`(?:, `(\w+)`)?", self.text)
        self.assertGreater(len(named), 5)
        for path, column in named:
            with open(report.ROOT / "results" / path, encoding="utf-8") as file:
                head = next(csv.reader(file))
            if column:
                self.assertIn(column, head, path)

    def test_its_make_targets_and_files_exist(self):
        makefile = read(report.ROOT / "Makefile")
        for target in set(re.findall(r"`make ([a-z-]+)", self.text)):
            self.assertRegex(makefile, rf"(?m)^{target}:", target)
        for path in re.findall(r"\]\(([^)#]+)\)", self.text):
            is_known = path.startswith("https://") or (report.ROOT / path).exists()
            self.assertTrue(is_known, path)


if __name__ == "__main__":
    report.run_tests("__main__")
