"""Figures that pages quote are those of the tables (plots/fill_pages.py)."""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "plots"))
import goal_tables  # noqa: E402
import quotes  # noqa: E402
from tables.results import Results  # noqa: E402

FILL = ROOT / "plots" / "fill_pages.py"


def fill(*arguments):
    """Runs the command."""
    return subprocess.run([sys.executable, FILL, *map(str, arguments)], capture_output=True,
                          text=True, check=False)


def all_pages():
    """The text of all pages of this tree."""
    return "".join(path.read_text(encoding="utf-8") for path in ROOT.rglob("*.md")
                   if "build" not in path.relative_to(ROOT).parts)


class Quotes(unittest.TestCase):
    def setUp(self):
        self.directory = pathlib.Path(tempfile.mkdtemp(prefix="dssbench-quotes-"))
        self.addCleanup(shutil.rmtree, self.directory)
        (self.directory / "tables").mkdir()
        (self.directory / "tables" / "speeds.csv").write_text(
            "who,speed_s,speed_low_s,speed_high_s,share\na,2,1.5,2.5,0.126\nb,3,,,0.5\n",
            encoding="utf-8")

    def text_of(self, line):
        """A quotation of the table of this test."""
        return quotes.quoted(Results(self.directory), line)

    def page(self, text, name="page.md"):
        """A page in the directory of this test."""
        path = self.directory / name
        path.write_text(text, encoding="utf-8")
        return path

    def test_pages_of_this_tree_quote_what_the_tables_say(self):
        result = fill("--check")
        self.assertEqual(result.stderr, "")
        self.assertEqual(result.returncode, 0)

    def test_a_goal_is_met_by_all_numbers_as_they_are_shown(self):
        goal = goal_tables.Goal("case", "measure", 0.75, None, "limit")
        for reached, verdict in (([0.75, 2], "yes"), ([0.746, 0.8], "yes"),
                                 ([0.744, 0.8], "1 of 2"), ([0.1], "no")):
            self.assertEqual(goal.verdict(reached), verdict, reached)

    def test_a_goal_reads_every_number_of_its_trials(self):
        folder = self.directory / "trials" / "tables"
        folder.mkdir(parents=True)
        (folder / "trials.csv").write_text('name,figure\na,"1.01, 0.87 and 0.83"\nb,2.0\n',
                                           encoding="utf-8")
        self.assertEqual(goal_tables.of_trials("a", "b")(Results(self.directory)),
                         [1.01, 0.87, 0.83, 2.0])
        with self.assertRaisesRegex(goal_tables.NotMeasured, "no row c"):
            goal_tables.of_trials("c")(Results(self.directory))

    def test_a_planted_figure_in_readme_is_found(self):
        text = (ROOT / "README.md").read_text(encoding="utf-8")
        found = quotes.MARK.search(text)
        self.assertTrue(found, "README.md quotes no figure")
        planted = text.replace(found.group(0), found.group(0).replace(found.group(2), "123456"))
        self.assertNotEqual(planted, text)
        path = self.page(planted, "README.md")
        result = fill("--check", path)
        self.assertEqual(result.returncode, 1)
        self.assertIn("123456", result.stderr)
        self.assertEqual(path.read_text(encoding="utf-8"), planted, "--check wrote the page")
        self.assertEqual(fill(path).returncode, 0)
        self.assertEqual(path.read_text(encoding="utf-8"), text)

    def test_a_planted_row_of_a_table_is_found(self):
        text = (ROOT / "README.md").read_text(encoding="utf-8")
        found = quotes.TABLE.search(text)
        planted = text.replace(found.group(4), found.group(4) + "| planted |\n")
        self.assertEqual(fill("--check", self.page(planted)).returncode, 1)

    def test_a_quotation_is_a_value_an_interval_a_number_of_rows_or_over_all_rows(self):
        for line, expected in (("speeds | who == 'a' | speed_s | {:.1f} s", "2.0 s"),
                               ("speeds | who == 'a' | speed_s | {:.1f} [{:.1f}, {:.1f}]",
                                "2.0 [1.5, 2.5]"),
                               ("speeds | who == 'a' | share | {:.1%}", "12.6 %"),
                               ("speeds | | count | {}", "2"),
                               ("speeds | | max speed_s | {}", "3"),
                               ("speeds | | range speed_s | {} to {}", "2 to 3")):
            self.assertEqual(self.text_of(line), expected)

    def test_what_is_not_there_is_said(self):
        for line, words in (("speeds | | speed_s | {}", "2 rows fit"),
                            ("speeds | who == 'a' | weight | {}", "no column weight"),
                            ("speeds | who == 'b' | speed_s | {} [{}, {}]", "no value of speed_s"),
                            ("speeds | who == 'a' | share | {} [{}, {}]", "no interval")):
            with self.assertRaisesRegex(quotes.Unknown, words):
                self.text_of(line)
        result = fill("--check", self.page("It is <!--no_such_name-->7<!--/--> times."))
        self.assertIn("no_such_name: is not in plots/quotes.toml", result.stderr)
        self.assertEqual(result.returncode, 1)

    def test_a_trial_is_quoted_by_its_name(self):
        (self.directory / "trials" / "tables").mkdir(parents=True)
        (self.directory / "trials" / "tables" / "trials.csv").write_text(
            "name,figure\na,0.9 to 1.1\ntwice,1\ntwice,2\n", encoding="utf-8")
        text, faults = quotes.filled("<!--trial_a-->5<!--/--> <!--trial_b-->6<!--/--> "
                                     "<!--trial_twice-->7<!--/-->", Results(self.directory), {})
        self.assertEqual(text, "<!--trial_a-->0.9 to 1.1<!--/--> <!--trial_b-->6<!--/--> "
                               "<!--trial_twice-->7<!--/-->")
        self.assertEqual(faults, ["trial_b: trials.csv has 0 rows b",
                                  "trial_twice: trials.csv has 2 rows twice"])

    def test_every_trial_is_quoted_and_says_where_it_was_measured(self):
        pages = all_pages()
        frame = Results(ROOT / "results" / "trials").table("trials", "name", "figure", "what",
                                                           "machine", "commit", "date")
        self.assertFalse(frame.isna().any().any())
        for name in frame["name"]:
            self.assertIn(f"<!--trial_{name}-->", pages)

    def test_every_quotation_of_the_list_is_used(self):
        pages = all_pages()
        for name in quotes.read_quotes():
            self.assertIn(f"<!--{name}-->", pages)


if __name__ == "__main__":
    unittest.main()
