"""Every command of the pages: run in a scratch directory, described by the help, or left out."""
import collections
import concurrent.futures
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import time
import unittest

import checks
import columns_page
import pages
import plan
import workplace
from lists import LISTS

PLAN = plan.make_plan(pages.all_commands(workplace.SOURCE), LISTS)


def run_page(commands):
    """Runs the commands of a page in their order: (command, fault, why it was skipped, seconds)."""
    with tempfile.TemporaryDirectory(prefix="dssbench-docs-") as directory:
        workplace.furnish(directory, [text for _, text in commands],
                          pages.scenes_of(pages.read_page(workplace.SOURCE, commands[0][0].page)))
        results = []
        for command, text in commands:
            start = time.monotonic()
            lack = workplace.why_not_here(workplace.with_variants_here(text))
            fault = "" if lack else checks.fault_of_run(command, text, LISTS, directory)
            results.append((command, fault, lack, time.monotonic() - start))
        return results


class Columns(unittest.TestCase):
    def test_the_page_of_columns_is_what_the_program_lists(self):
        listed = json.loads(workplace.asked("list", "columns", "--json")[1])
        self.assertGreater(len(listed), 100)
        self.assertEqual(pages.read_page(workplace.SOURCE, "results/columns.md"),
                         columns_page.page(listed), "run make pages")


class Surfaces(unittest.TestCase):
    """Scripts write the surfaces that are committed, up to the rounding of sines."""
    def numbers(self, path):
        """The corners of a binary STL file."""
        content = pathlib.Path(path).read_bytes()
        facets = struct.iter_unpack("<12fH", content[84:])
        return [number for facet in facets for number in facet[3:12]]

    def test_scripts_write_what_is_committed(self):
        scenes = pathlib.Path(workplace.SOURCE) / "experiments" / "scenes"
        for script in ("arm/make_arm.py", "verification/make_surfaces.py"):
            with tempfile.TemporaryDirectory() as directory:
                subprocess.run([sys.executable, scenes / script, directory], check=True)
                written = list(pathlib.Path(directory).glob("*.stl"))
                self.assertTrue(written)
                for path in written:
                    there = self.numbers((scenes / script).parent / path.name)
                    here = self.numbers(path)
                    self.assertEqual(len(here), len(there))
                    largest = max(map(abs, there))
                    self.assertLess(max(abs(a - b) for a, b in zip(here, there)), 1e-6 * largest)


class Pages(unittest.TestCase):
    def test_each_published_problem_has_a_page_with_its_results(self):
        folder = "experiments/studies/verification"
        study = json.loads(pages.read_page(workplace.SOURCE, f"{folder}/verification.json"))
        for problem in (each["problem"] for each in study["verification"]):
            text = pages.read_page(workplace.SOURCE, f"{folder}/problems/{problem}.md")
            for part in ("Statement", "Reference", "Here", "Results", "Sources"):
                self.assertIn(f"\n## {part}\n", text, problem)
            self.assertIn(f"<!--table problem {problem}-->\n|", text)
            self.assertIn(f"(problems/{problem}.md)",
                          pages.read_page(workplace.SOURCE, f"{folder}/README.md"))

    def test_every_command_is_run_described_or_left_out_with_a_reason(self):
        self.assertEqual(PLAN.faults, [])
        self.assertGreater(len(PLAN.run), 60)

    def test_every_named_subcommand_and_option_is_in_the_help(self):
        faults = [checks.fault_of_description(command) for command in PLAN.described]
        self.assertEqual([fault for fault in faults if fault], [])

    def test_every_command_ends_with_the_exit_code_that_its_page_states(self):
        by_page = collections.defaultdict(list)
        for command, text in PLAN.run:
            by_page[command.page].append((command, text))
        longest_first = sorted(by_page.values(), key=len, reverse=True)
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            results = [each for page in pool.map(run_page, longest_first) for each in page]
        print(f"{len(PLAN.run)} commands run, {len(PLAN.described)} described, "
              f"{len(PLAN.left_out)} left out")
        for command, fault, lack, seconds in results:
            print(f"{seconds:6.2f} s  {command.place()}  {command.text}{' SKIPPED' * bool(lack)}")
            with self.subTest(command.text):
                if lack:
                    self.skipTest(lack)
                self.assertFalse(fault, fault)


if __name__ == "__main__":
    unittest.main()
