"""The test of the pages can fail: planted pages, with what must be said of each."""
import os
import tempfile
import unittest

import checks
import pages
import plan
import workplace

PAGE = """Prose with `dssbench list scenes` and `dssbench verify
--variant scalar`, a file's name `plots/page.py`, a word `dss_variant`.

    $ dssbench run plate    # exits with 3
    ...
    step 1 of 2
    make of a transcript is no command
    $ make test

    FORCE=1 dssbench explain A|B
    {"scene": "make"}

| `make bench` | `dssbench run SCENE [--set KEY=VALUE]` |

```sh
frobnicate --all
```

`dssbench compare a b` (exits with 1 if they differ). `list devices --measure`
"""


def found(text):
    return [(command.line, command.text, command.exit_code)
            for command in pages.commands_of("page.md", text)]


def planned(text, **lists):
    return plan.make_plan(pages.commands_of("page.md", text), plan.Lists(**lists))


class Extractor(unittest.TestCase):
    def test_commands_are_found_in_blocks_transcripts_tables_and_prose(self):
        self.assertEqual(found(PAGE), [
            (1, "dssbench list scenes", 0), (1, "dssbench verify --variant scalar", 0),
            (4, "dssbench run plate", 3), (8, "make test", 0),
            (10, "FORCE=1 dssbench explain A", 0), (10, "FORCE=1 dssbench explain B", 0),
            (13, "make bench", 0), (13, "dssbench run SCENE [--set KEY=VALUE]", 0),
            (16, "frobnicate --all", 0),
            (19, "dssbench compare a b", 1), (19, "dssbench list devices --measure", 0)])

    def test_the_lines_of_a_transcript_belong_to_its_command(self):
        output = {command.text: command.output for command in pages.commands_of("page.md", PAGE)}
        self.assertEqual(output["dssbench run plate"],
                         ("step 1 of 2", "make of a transcript is no command"))

    def test_an_exit_code_under_a_condition_is_not_the_stated_one(self):
        self.assertEqual(found("    dssbench verify a  # exit 1 on any failure")[0][2], 0)

    def test_a_tree_without_git_has_the_same_pages(self):
        with tempfile.TemporaryDirectory() as root:
            for name in ("README.md", "deep/er/PAGE.md", "build/made.md", "text.txt"):
                os.makedirs(os.path.dirname(f"{root}/{name}"), exist_ok=True)
                with open(f"{root}/{name}", "w", encoding="utf-8") as file:
                    file.write("`make`\n")
            self.assertEqual(pages.tracked_pages(root), ["README.md", "deep/er/PAGE.md"])
            self.assertEqual(len(pages.all_commands(root)), 2)


class Lists(unittest.TestCase):
    def test_a_program_that_no_list_knows_is_a_fault(self):
        faults = planned("    srun -n 2 dssbench").faults
        self.assertEqual(faults, ["page.md:1: `srun -n 2 dssbench` is neither run nor left out"])
        self.assertEqual(len(planned("```sh\nfrobnicate --all\n```").faults), 1)

    def test_an_entry_that_fits_no_command_is_a_fault(self):
        for lists in ({"left_out": (("^srun", "no cluster"),)},
                      {"replaced": (("n=3", "n=2", "size"),)},
                      {"transcripts": (("run", "list", "size"),)},
                      {"own_lines": (("^mpi", "name"),)}):
            self.assertRegex(planned("    dssbench run a", **lists).faults[0], "fits no command")

    def test_a_transcript_is_not_run_smaller(self):
        lists = {"replaced": (("n=300", "n=20", "size"),)}
        text = "    dssbench run a --set n=300\n\n    $ dssbench run b --set n=300\n    state 1"
        self.assertEqual([text for _, text in planned(text, **lists).run],
                         ["dssbench run a --set n=20", "dssbench run b --set n=300"])

    def test_equal_commands_are_run_once_with_the_transcript(self):
        run = planned("`dssbench list scenes`\n\n    $ dssbench list scenes\n    two_elements").run
        self.assertEqual([command.output for command, _ in run], [("two_elements",)])

    def test_names_synopses_and_placeholders_are_not_run(self):
        text = ("`dssbench bench --attribution` `dssbench run OLD` `dssbench run a [--set x]` "
                "`make` `dssbench run a ...`")
        plan_of_text = planned(text, placeholders=("OLD",))
        self.assertEqual(len(plan_of_text.described), 4)
        self.assertEqual([text for _, text in plan_of_text.run], ["make"])


class Checks(unittest.TestCase):
    def fault(self, text, own_lines=()):
        """The fault of the only command of a page, as it is run."""
        with tempfile.TemporaryDirectory() as directory:
            workplace.furnish(directory, [])
            lists = plan.Lists(own_lines=own_lines)
            command, text = plan.make_plan(pages.commands_of("page.md", text), lists).run[0]
            return checks.fault_of_run(command, text, lists, directory)

    def test_another_exit_code_than_the_stated_one_is_a_fault(self):
        self.assertEqual(self.fault("    dssbench list scenes"), "")
        self.assertEqual(self.fault("    dssbench list nothing  # exits with 2"), "")
        self.assertRegex(self.fault("    dssbench list nothing"),
                         "page.md:1: .* ended with 2 in place of 0")
        self.assertRegex(self.fault("    dssbench list scenes  # exits with 2"),
                         "ended with 0 in place of 2")

    def test_a_shown_line_that_is_not_printed_is_a_fault(self):
        page = "    $ dssbench list methods\n    ...\n    a method of no order\n"
        self.assertRegex(self.fault(page), "did not print .'a method of no order'")
        self.assertEqual(self.fault(page, own_lines=(("no order", "differs"),)), "")

    def test_a_scene_that_a_page_shows_can_be_run(self):
        page = """Text.

            {
              "scene": "own",
              "bodies": []
            }

            dssbench list scenes
            {"no scene": 1}
        """
        self.assertEqual([name for name, _ in pages.scenes_of(page)], ["own.json"])

    def test_a_page_that_names_an_unknown_option_or_subcommand_is_a_fault(self):
        for text, words in (("`dssbench run --frobnicate`", "the help of run lacks --frobnicate"),
                            ("`dssbench frobnicate`", "there is no help of frobnicate"),
                            ("`dssbench run --steps`", ""), ("`cmake --install`", "")):
            command = pages.commands_of("page.md", text)[0]
            self.assertRegex(checks.fault_of_description(command), words or "^$")


if __name__ == "__main__":
    unittest.main()
