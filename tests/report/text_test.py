"""What the report says, without a browser: figures, what is missing, what is old, and the claims of ARTIFACT.md."""
import csv
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import report
import sample

try:
    import matplotlib  # noqa: F401
    import pandas  # noqa: F401
except ImportError as missing:
    report.skip_all(f"this python has no {missing.name}")


class ReportTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory(prefix="dssbench-report-")
        cls.addClassCleanup(holder.cleanup)
        cls.directory = pathlib.Path(holder.name)
        sample.write_sample(cls.directory / "sample")
        report.copy_committed(cls.directory / "committed")
        # Without Plotly: what is asked here does not need it. An environment that cannot be made is what having no network looks like.
        (cls.directory / "no-directory").write_text("", encoding="utf-8")
        cls.pages = {}
        for name in ("sample", "committed"):
            result = report.make_report(cls.directory / name, cls.directory / "no-directory" / "environment")
            if result.returncode:
                raise AssertionError(result.stderr)
            cls.said = result.stderr
            cls.pages[name] = (cls.directory / name / "report.html").read_text(encoding="utf-8")

    def test_without_plotly_one_line_says_so_and_the_tables_are_there(self):
        self.assertEqual(self.said.count("\n"), 1, self.said)
        self.assertIn("Plotly cannot be installed", self.said)
        self.assertIn("table1_host.csv:4", self.pages["sample"])
        self.assertNotIn('class="chart"', self.pages["sample"])

    def test_the_summary_has_the_figures_of_the_tables(self):
        with open(self.directory / "committed" / "tables" / "table1_host.csv", encoding="utf-8") as file:
            rows = [row for row in csv.DictReader(file) if row["source"] == "measured" and row["status"] == "ok"]
        best = max(float(row["speedup_vs_reference"] or row["extrapolated_speedup_vs_reference"] or 0) for row in rows)
        self.assertIn(f"{best:.3g} [", self.pages["committed"].split('id="old-and-missing"')[0])
        self.assertIn("16 times as fast", self.pages["sample"])
        self.assertIn("within an error of 8.9e-05 reaches 1024 times (f32)", self.pages["sample"])  # the last link is farther, and off by more
        self.assertIn("The fastest link within the allowed error is 1024 times the reference (f32)", self.pages["sample"])
        self.assertIn("1 of 3 cells of the failure atlas", self.pages["sample"])

    def test_what_is_missing_is_said_with_the_command(self):
        for study in ("work_precision", "stability", "table2", "cluster"):
            self.assertRegex(self.pages["sample"], rf"Not measured: run <code>dssbench experiment {study}</code>")
        self.assertIn("tables/advise.csv is of another version", self.pages["sample"])
        self.assertIn("tables/statics.csv has no rows", self.pages["sample"])

    def test_old_records_are_named_with_their_date_and_reason(self):
        page = self.pages["sample"]
        roofline = page[page.index('id="roofline"'):page.index('id="attribution"')]
        self.assertIn('<strong class="old">old</strong>: of 2029-12-30 12:00 UTC; made by commit 000000000', roofline)
        atlas = page[page.index('id="atlas"'):page.index('id="advice"')]
        self.assertIn("of an earlier session", atlas)
        chain = page[page.index('id="chain"'):page.index('id="roofline"')]
        self.assertIn("4 of 7 records are", chain)
        self.assertIn("kept by --resume", chain)
        host = page[page.index('id="table-1-host"'):page.index('id="table-1-host"') + 400]
        self.assertNotIn("old", host)

    def test_a_table_without_a_record_is_of_unknown_age_whatever_the_time_of_its_file(self):
        directory = self.directory / "unrecorded"
        sample.write_sample(directory)
        os.utime(directory / "tables" / "advise.csv", (0, 0))
        os.utime(directory / "tables" / "statics.csv", (2e9, 2e9))
        self.assertEqual(report.make_report(directory, self.directory / "no-directory" / "environment").returncode, 0)
        page, text = [(directory / name).read_text(encoding="utf-8") for name in ("report.html", "REPORT.md")]
        for study in ("advise", "statics"):
            self.assertIn(f"age unknown: no raw/{study}.json says which commit made it", page.split('id="all-tables"')[1])
        for written in (page.split('id="tables"')[0], text):
            self.assertIn("3 of 4 records are old, wholly or in part, while 2 tables have no record", written)
            self.assertRegex(written, "No record in raw/ says when these tables were made: .*advise.*statics")

    def test_every_record_is_in_the_environment_with_its_commit(self):
        environment = self.pages["committed"].split('id="environment"')[1]
        for path in (self.directory / "committed" / "raw").glob("*.json"):
            context = json.loads(path.read_text(encoding="utf-8")).get("context")
            if context:
                self.assertIn(context["git_commit"][:12], environment)
        self.assertIn("A &lt;processor&gt;", self.pages["sample"])

    def test_every_line_that_is_shown_is_a_line_of_its_table(self):
        for name, page in self.pages.items():
            shown = set(re.findall(r'href="((?:\w+/)?tables/\w+\.csv)">[^<]*:(\d+)<', page))
            self.assertGreater(len(shown), 10)
            for path, line in shown:
                lines = (self.directory / name / path).read_text(encoding="utf-8").count("\n")
                self.assertTrue(2 <= int(line) <= lines, (name, path, line))

    def test_a_row_names_the_line_that_it_is_from(self):
        lines = (self.directory / "committed" / "tables" / "table1_host.csv").read_text(encoding="utf-8").splitlines()
        head = lines[0].split(",")
        section = self.pages["committed"].split('id="table-1-host"')[1].split("</section>")[0]
        found = re.findall(r'<th[^>]*scope="row">([^<]*)</th>.*?table1_host\.csv:(\d+)</a>', section)
        self.assertGreater(len(found), 5)
        for label, line in found:
            row = next(csv.reader([lines[int(line) - 1]]))
            self.assertEqual(label, row[head.index("label")])

    def test_the_kinds_of_figures_stand_in_columns_of_their_own(self):
        for section in (self.pages["committed"].split(f'id="{name}"')[1].split("</section>")[0] for name in ("table-1", "table-2")):
            for kind in ("paper", "measured", "simulated"):
                self.assertRegex(section, rf'<th colspan="\d" scope="colgroup" class="{kind} first">')
                self.assertRegex(section, rf'<td class="{kind}[^"]*">[^<]*\d')

    def test_the_markdown_has_the_same_summary_and_links_that_lead_somewhere(self):
        directory = self.directory / "committed"
        text = (directory / "REPORT.md").read_text(encoding="utf-8")
        self.assertRegex(text, r"(?m)^3\. ")
        links = re.findall(r"\]\(([^)]+)\)", text)
        self.assertGreater(len(links), 50)
        for link in set(links) - {"report.html"}:
            self.assertTrue((directory / link).exists(), link)

    def odd_page(self, name, table, columns):
        """The sample with columns of a table that have no value: the command's result and the page."""
        directory, path = self.directory / name, self.directory / name / "tables" / f"{table}.csv"
        sample.write_sample(directory)
        with open(path, encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        sample.write_table(directory, table, ",".join(rows[0]), [["" if column in columns else value for column, value in row.items()] for row in rows])
        result = report.make_report(directory, self.directory / "no-directory" / "environment")
        return result, (directory / "report.html").read_text(encoding="utf-8")

    def test_one_odd_table_leaves_the_other_sections_and_ends_with_an_error(self):
        result, page = self.odd_page("odd", "kernels", ["kernel"])
        self.assertEqual(result.returncode, 1)
        self.assertIn("Roofline: tables/kernels.csv cannot be drawn: KeyError: ", result.stderr)
        self.assertNotIn("Traceback", result.stderr)
        self.assertIn("Tables/kernels.csv cannot be drawn: KeyError: nan</p>", page)
        self.assertIn("1 section cannot be drawn", page)
        self.assertIn('<details><summary>As a table', page[page.index('id="chain"'):page.index('id="roofline"')])
        self.assertIn("Roofline: tables/kernels.csv cannot be drawn", (self.directory / "odd" / "REPORT.md").read_text(encoding="utf-8"))

    def test_a_column_without_a_value_is_left_out_of_the_words(self):
        result, page = self.odd_page("blank", "kernels", ["limiter"])
        self.assertEqual(result.returncode, 0, result.stderr)
        roofline = page[page.index('id="roofline"'):page.index('id="attribution"')]
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
        plots = report.ROOT / "plots"
        result = subprocess.run([sys.executable, plots / "make_plots.py", "--results", directory], capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        draw = "import sys; sys.path.insert(0, sys.argv[1]); import body_picture, pathlib; body_picture.write(body_picture.plt.figure(), pathlib.Path(sys.argv[2]))"
        subprocess.run([sys.executable, "-c", draw, plots, directory / "figures" / "l_bracket.png"], check=True)
        by_others = "import sys; sys.path.insert(0, sys.argv[1]); import body_picture; body_picture.plt.figure().savefig(sys.argv[2])"
        subprocess.run([sys.executable, "-c", by_others, plots, directory / "figures" / "plate_paper.png"], check=True)
        self.assertEqual(report.make_report(directory, self.directory / "no-directory" / "environment").returncode, 0)
        page, text = [(directory / name).read_text(encoding="utf-8") for name in ("report.html", "REPORT.md")]
        self.assertIn("(figures/failures.png), measured by commit 111111111, 2030-01-01 12:00 UTC", text)
        self.assertTrue("figures/plate_paper.png</a>, age unknown</figcaption>" in page)  # not assertIn, which would print the whole page
        self.assertRegex(page, r"figures/l_bracket.png</a>, drawn by commit \w+, \d{4}-\d\d-\d\d \d\d:\d\d UTC</figcaption>")

    def test_no_results_are_an_error_in_one_line(self):
        os.makedirs(self.directory / "empty", exist_ok=True)
        result = report.make_report(self.directory / "empty")
        self.assertEqual(result.returncode, 1)
        self.assertEqual(result.stderr.count("\n"), 1)
        self.assertIn("no tables", result.stderr)


class Documents(unittest.TestCase):
    def test_no_figure_waits_to_be_filled_in(self):
        for name in ("README.md", "ARTIFACT.md", "HACKING.md"):
            self.assertEqual(re.findall(r"\b(?:CHAIN|ATTR)_[A-Z0-9]+\b", (report.ROOT / name).read_text(encoding="utf-8")), [], name)


class Artifact(unittest.TestCase):
    """ARTIFACT.md names commands and files that exist."""

    def setUp(self):
        self.text = (report.ROOT / "ARTIFACT.md").read_text(encoding="utf-8")

    def test_its_studies_exist(self):
        studies = re.findall(r"dssbench experiment (\w+)", self.text)
        self.assertGreater(len(studies), 5)
        for study in studies:
            self.assertTrue(list((report.ROOT / "experiments" / "studies").glob(f"*/{study}.json")), study)

    def test_its_scenes_exist(self):
        scenes = re.findall(r"dssbench (?:run|verify|advise|explain|stability|simulate) (?!-)(\w+)", self.text)
        self.assertTrue(scenes)
        for scene in scenes:
            self.assertTrue((report.ROOT / "experiments" / "scenes" / f"{scene}.json").exists(), scene)

    def test_its_tables_are_committed_and_have_the_columns(self):
        named = re.findall(r"`((?:h100/)?tables/\w+\.csv)`(?:, `(\w+)`)?", self.text)
        self.assertGreater(len(named), 5)
        for path, column in named:
            with open(report.ROOT / "results" / path, encoding="utf-8") as file:
                head = next(csv.reader(file))
            if column:
                self.assertIn(column, head, path)

    def test_its_make_targets_and_files_exist(self):
        makefile = (report.ROOT / "Makefile").read_text(encoding="utf-8")
        for target in set(re.findall(r"`make ([a-z-]+)", self.text)):
            self.assertRegex(makefile, rf"(?m)^{target}:", target)
        for path in re.findall(r"\]\(([^)#]+)\)", self.text):
            self.assertTrue(path.startswith("https://") or (report.ROOT / path).exists(), path)


if __name__ == "__main__":
    report.run_tests("__main__")
