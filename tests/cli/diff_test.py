"""`diff`: how far two states or two histories are apart."""
import json
import math
import unittest

from program import ProgramTest, dssbench, record

SCENE = ["plate_paper", "--set", "n=6", "--variant", "scalar"]


class Diff(ProgramTest):
    def run_scene(self, name, *options):
        """The state and the history of a run."""
        state, history = self.path(f"{name}.csv"), self.path(f"{name}-history.csv")
        record("run", *SCENE, *options, "--state", state, "--history", history, "--every", 10)
        return state, history

    def quantities(self, *files):
        """The differences by quantity."""
        return {one["quantity"]: one for one in record("diff", *files)["quantities"]}

    def test_equal_runs_have_no_difference(self):
        first, second = self.run_scene("a", "--steps", 40), self.run_scene("b", "--steps", 40)
        for pair in zip(first, second):
            for one in self.quantities(*pair).values():
                self.assertEqual((one["largest_difference"], one["relative"]), (0, 0))

    def test_differences_are_those_of_the_columns(self):
        (a, history_a), (b, history_b) = (self.run_scene(name, "--dt", dt, "--steps", steps)
                                          for name, dt, steps in (("a", 1e-6, 40), ("b", 5e-7, 60)))
        rows = [[dict(zip(self.lines(path)[0], map(float, row))) for row in self.lines(path)[1:]]
                for path in (a, b)]

        def norm(row):
            return math.hypot(row["ux"], row["uy"], row["uz"])

        apart = [norm({axis: two[axis] - one[axis] for axis in ("ux", "uy", "uz")})
                 for one, two in zip(*rows)]
        found = self.quantities(a, b)["displacement"]
        self.assertAlmostEqual(found["largest_difference"] / max(apart), 1, 12)
        self.assertAlmostEqual(found["relative"] / (max(apart) / max(map(norm, rows[0]))), 1, 12)
        self.assertEqual(found["place"], f"element {apart.index(max(apart))}")
        # Times of both: 0, 10, 20 and 30 us.
        self.assertEqual(record("diff", history_a, history_b)["rows"], 4)
        energy = self.quantities(history_a, history_b)["energy"]
        self.assertTrue(0 < energy["relative"] < 1e-3, energy)

    def lines(self, path):
        """The rows of a file of CSV."""
        with open(path, encoding="utf-8") as file:
            return [line.rstrip("\n").split(",") for line in file]

    def test_a_rotation_and_its_negative_are_one(self):
        state, _ = self.run_scene("a", "--steps", 40)
        head, *rows = self.lines(state)
        places = [head.index(name) for name in ("qw", "qx", "qy", "qz")]
        for row in rows:
            for place in places:
                row[place] = repr(-float(row[place]))
        other = self.write("b.csv", "".join(",".join(row) + "\n" for row in (head, *rows)))
        self.assertEqual(self.quantities(state, other)["rotation"]["largest_difference"], 0)

    def test_a_tolerance_decides_the_exit_code(self):
        (a, _), (b, _) = (self.run_scene(name, "--steps", steps)
                          for name, steps in (("a", 40), ("b", 50)))
        for tolerance, code in ((1e9, 0), (1e-6, 1)):
            result = dssbench("diff", a, b, "--tolerance", tolerance)
            self.assertEqual(result.returncode, code, result.stdout + result.stderr)
            self.assertIn("displacement [m]", result.stdout)
        self.assertEqual(json.loads(dssbench("diff", a, a, "--json", "-").stdout)["rows"], 36)

    def test_files_that_cannot_be_compared_are_refused_in_one_line(self):
        state, history = self.run_scene("a", "--steps", 40)
        text = self.read("a.csv")
        lines = text.splitlines(keepends=True)

        def with_value(value):
            cells = lines[20].split(",")
            return "".join([*lines[:20], ",".join([*cells[:4], value, *cells[5:]]), *lines[21:]])

        for other, words in (
            (history, ["is a state", "two of one kind"]),
            (self.write("short.csv", "".join(lines[:-1])), ["35 elements", "has more"]),
            (self.write("empty.csv", ""), ["neither a state", "nor a history"]),
            (self.write("word.csv", with_value("much")),
             ["word.csv:21", '"ux" has no finite number']),
            (self.write("nan.csv", with_value("nan")), ["nan.csv:21"]),
            (self.write("torn.csv", text[:-40]), ["torn.csv:37"]),
            (self.path("no.csv"), ["no.csv", "cannot be read"]),
        ):
            with self.subTest(other=other):
                self.assert_refused(2, words, "diff", state, other)
        far = self.path("far.csv")
        record("run", "plate_paper", "--set", "n=7", "--steps", 1, "--state", far)
        self.assert_refused(2, ["another place", "one body"], "diff", state, far)
        self.assert_refused(2, ["a.csv"], "diff", state, state, "--json", state)
        self.assertEqual(self.read("a.csv"), text)


if __name__ == "__main__":
    unittest.main()
