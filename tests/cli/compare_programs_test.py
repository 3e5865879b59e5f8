"""`compare -- A -- B`: any two programs, timed in turn."""
import csv
import json
import os
import unittest

from program import ProgramTest, dssbench

FEW = ["--repetitions", 6, "--patience", 0]


class ComparePrograms(ProgramTest):
    def compare(self, *arguments):
        """The finished process and the result."""
        result = dssbench("compare", *FEW, "--json", "-", *arguments)
        return result, json.loads(result.stdout) if result.stdout else None

    def test_a_program_that_takes_ten_times_as_long_is_slower(self):
        quick, long = ["sleep", "0.02"], ["sleep", "0.2"]
        for first, second, code, word in ((quick, long, 1, "slower"), (long, quick, 0, "faster")):
            result, found = self.compare("--", *first, "--", *second)
            self.assertEqual(result.returncode, code, result.stderr)
            self.assertIn(f"B is {word}", found["verdict"])
            self.assertEqual([one["name"] for one in found["programs"]], ["A", "A again", "B"])
            self.assertEqual([one["repetitions"] for one in found["programs"]], [6, 6, 6])
            self.assertEqual(found["programs"][2]["command"], second)
            self.assertTrue(found["ratio_low"] <= found["ratio"] <= found["ratio_high"])

    def test_a_program_does_not_differ_from_itself_by_a_factor(self):
        result, found = self.compare("--", "sleep", "0.05", "--", "sleep", "0.05")
        self.assertTrue(0.5 < found["ratio"] < 2, found)
        self.assertEqual(result.returncode == 1, "slower" in found["verdict"])
        self.assertIsNone(found["rank_sum_p"])

    def test_each_run_is_a_row_and_the_table_is_markdown(self):
        runs, table, record = (self.path(name) for name in ("runs.csv", "table.md", "pair.json"))
        log = self.path("log")
        one = ["sh", "-c", f"echo one >> {log}"]
        result = dssbench("compare", *FEW, "--warmup", 2, "--csv", runs, "--markdown", table,
                          "--json", record, "--", *one, "--", f"WORD=two {log}", "sh", "-c",
                          'set -- $WORD; echo $1 >> $2')
        self.assertIn(result.returncode, (0, 1), result.stderr)
        self.assertIn("A again", result.stdout)
        with open(runs, encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        for program in ("A", "A again", "B"):
            own = [row for row in rows if row["program"] == program and row["attempt"] == "0"]
            self.assertEqual([row["repetition"] for row in own], [f"{n}" for n in range(6)])
            self.assertTrue(all(float(row["wall_s"]) > 0 for row in own))
        words = self.read("log").split()
        self.assertEqual((words.count("one"), words.count("two")), (16, 8))
        self.assertRegex(self.read("table.md"), r"(?s)\| program \|.*\| B \|.*Verdict: ")
        self.assertEqual(len(json.loads(self.read("pair.json"))["programs"]), 3)

    def test_a_program_that_fails_is_an_error_and_nothing_is_written(self):
        target = self.path("runs.csv")
        for command, words in ((["sh", "-c", "echo broken >&2; exit 3"],
                                ["B (sh", "exit code 3: broken"]),
                               (["no-such-program"], ["no-such-program", "exit code 127"]),
                               (["sleep", "20"], ["time limit of 1 s"])):
            result = dssbench("compare", *FEW, "--csv", target, "--time-limit", 1, "--", "true",
                              "--", *command)
            self.assertEqual((result.returncode, result.stdout), (2, ""))
            for word in words:
                self.assertIn(word, result.stderr.splitlines()[-1])
            self.assertFalse(os.path.exists(target))

    def test_words_of_commands_reach_them_as_they_are(self):
        log = self.path("log")
        self.compare("--", "true", "--", "sh", "-c", 'echo "$@" >> $0', log, "[a,b]", "--set", "-x")
        self.assertEqual(set(self.read("log").splitlines()), {"[a,b] --set -x"})

    def test_what_is_no_pair_is_refused(self):
        for line in ([], ["a.csv"], ["--", "true"], ["--", "true", "--"],
                     ["--", "a", "--", "b", "--", "c"], ["a.csv", "--", "true", "--", "true"],
                     ["--repetitions", "6", "--", "true", "false", "true"]):
            self.assert_refused(2, ["--"], "compare", *line)
        self.assert_refused(2, ["--repetitions"], "compare", "--repetitions", 5, "--", "a", "--",
                            "b")
        self.assert_refused(2, ["--csv", "for commands"], "compare", "a.csv", "b.csv", "--csv", "x")
        self.assert_refused(2, ["--csv -"], "compare", "--csv", "-", "--", "a", "--", "b")
        self.assert_refused(2, [self.path("no/x")], "compare", "--json", self.path("no/x"), "--",
                            "true", "--", "true")
        same = self.path("x")
        self.assert_refused(2, [same], "compare", "--json", same, "--csv", same, "--", "true",
                            "--", "true")


if __name__ == "__main__":
    unittest.main()
