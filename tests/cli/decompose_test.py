"""`decompose`: its report, its file, and what it refuses."""
import json
import os
import pathlib
import random
import subprocess
import sys
import unittest

from program import ProgramTest, dssbench

ROOT = pathlib.Path(__file__).resolve().parents[2]
PLATE = ("decompose", "plate_paper", "--set", "n=12")
HAS_METIS = dssbench(*PLATE, "--parts", "2", "--method", "metis").returncode == 0
METHODS = ("strips", "blocks", "metis") if HAS_METIS else ("strips", "blocks")


def runs(pairs):
    return [number for first, count in pairs for number in range(first, first + count)]


class Decompose(ProgramTest):
    def report(self, *arguments):
        result = dssbench(*arguments, "--json", "-")
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def file_of(self, *arguments):
        path = self.path("parts.json")
        result = dssbench(*arguments, "--output", path)
        self.assertEqual(result.returncode, 0, result.stderr)
        return path

    def plate_file(self):
        """The file of a plate in two strips, as a Python value."""
        return json.loads(
            pathlib.Path(self.file_of(*PLATE, "--parts", "2")).read_text(encoding="utf-8"))

    def assert_file_refused(self, content, *words):
        text = content if isinstance(content, str) else json.dumps(content)
        self.assert_refused(2, ["bad.json", *words], *PLATE, "--from", self.write("bad.json", text))

    def test_the_report_has_the_numbers_of_each_part(self):
        report = self.report(*PLATE, "--parts", "3")
        self.assertEqual([part["own_elements"] for part in report["parts"]], [48, 48, 48])
        self.assertEqual([part["neighbours"] for part in report["parts"]], [1, 2, 1])
        self.assertEqual([part["halo_elements"] for part in report["parts"]], [12, 24, 12])
        self.assertEqual([part["sent_bytes_per_step"] for part in report["parts"]],
                         [12 * 104, 24 * 104, 12 * 104])
        self.assertEqual((report["cut_links"], report["halo_bytes_per_step"], report["imbalance"]),
                         (24, 48 * 104, 1))

    def test_a_deeper_halo_has_more_layers(self):
        self.assertEqual(self.report(*PLATE, "--parts", "2", "--depth", "0")["halo_elements"], 0)
        self.assertEqual(
            self.report(*PLATE, "--parts", "2", "--depth", "4")["halo_elements"], 2 * 4 * 12)

    def test_speeds_shift_the_shares_and_count_in_the_imbalance(self):
        for method in METHODS:
            report = self.report(*PLATE, "--method", method, "--parts", "3", "--speeds", "1,1,2")
            self.assertAlmostEqual(report["parts"][2]["cost_share"], 0.5, delta=12 / 144)
            self.assertLess(report["imbalance"], 1.1)

    def test_a_table_shows_at_most_sixteen_parts(self):
        text = dssbench(*PLATE, "--method", "blocks", "--parts", "16").stdout
        self.assertNotIn("...", text)
        self.assertEqual(len(text.splitlines()), 1 + 1 + 16 + 1)
        text = dssbench(*PLATE, "--method", "blocks", "--parts", "17").stdout
        self.assertIn("\n...\n", text)
        self.assertEqual(len(text.splitlines()), 1 + 1 + 16 + 1 + 1)

    def test_a_file_gives_back_what_was_written(self):
        for scene in ("plate_paper", "two_bodies", "l_bracket"):
            for method in METHODS:
                path = self.file_of("decompose", scene, "--parts", "5", "--method", method,
                                    "--depth", "2")
                written = self.read("parts.json")
                again = self.path("again.json")
                report = self.report("decompose", scene, "--from", path, "--depth", "2", "--output",
                                     again)
                self.assertEqual(self.read("again.json"), written)
                self.assertEqual(
                    report,
                    self.report("decompose", scene, "--parts", "5", "--method", method, "--depth",
                                "2"))

    def test_addresses_and_boundaries_of_a_file_fit_each_other(self):
        for method in METHODS:
            content = json.loads(
                pathlib.Path(
                    self.file_of("decompose", "l_bracket", "--parts", "4", "--method",
                                 method)).read_text(encoding="utf-8"))
            own = [runs([run[1:] for run in part["addresses"]]) for part in content["parts"]]
            self.assertEqual(sorted(sum(own, [])), list(range(content["elements"])))
            sent = {(part["part"], face["part"]): runs(face["send"])
                    for part in content["parts"]
                    for face in part["boundary"]}
            received = {(face["part"], part["part"]): runs(face["receive"])
                        for part in content["parts"]
                        for face in part["boundary"]}
            self.assertEqual(sent, received)
            for (sender, _), elements in sent.items():
                self.assertLessEqual(set(elements), set(own[sender]))

    def test_segments_alone_are_enough(self):
        halves = [{"segments": [[row, 0, 6] for row in range(12)]},
                  {"segments": [[row, 6, 12] for row in reversed(range(12))]}]
        path = self.write(
            "hand.json",
            json.dumps({"decomposition": 1, "elements": 144, "rows": 12, "parts": halves}))
        self.assertEqual(self.report(*PLATE, "--from", path)["cut_links"], 12)

    def test_a_file_of_another_size_is_refused(self):
        path = self.file_of(*PLATE, "--parts", "2")
        self.assert_refused(2, [path, "/elements", "144 is not 169", "another scene or size"],
                            "decompose", "plate_paper", "--set", "n=13", "--from", path)

    def test_a_file_that_does_not_fit_is_refused_with_the_place(self):
        def changed(change):
            content = self.plate_file()
            change(content["parts"])
            return content

        self.assert_file_refused(
            changed(lambda parts: parts[1]["segments"].pop() and parts[1].pop("own_elements")),
            "/parts:", "row 11", "x = 0")
        self.assert_file_refused(
            changed(lambda parts: parts[0]["segments"].append([7, 3, 9]) or parts[0].pop(
                "own_elements")), "/parts:", "[7, 3, 9]", "overlaps")
        self.assert_file_refused(changed(lambda parts: parts[0]["segments"].insert(0, [12, 0, 1])),
                                 "/parts/0/segments/0", "rows are 0 .. 11")
        self.assert_file_refused(changed(lambda parts: parts[1]["segments"].insert(2, [6, 0, 13])),
                                 "/parts/1/segments/2", "x = 0 .. 11")
        self.assert_file_refused(changed(lambda parts: parts[1]["segments"].insert(2, [6, -1, 3])),
                                 "/parts/1/segments/2", "[row, first x")
        self.assert_file_refused(
            changed(lambda parts: parts[1]["segments"].insert(0, [1e99, 0, 3])),
            "/parts/1/segments/0")
        self.assert_file_refused(changed(lambda parts: parts.append({"segments": []})),
                                 "/parts/2/segments")
        self.assert_file_refused(changed(lambda parts: parts.reverse()), "/parts/0/part",
                                 "1 is not 0")
        self.assert_file_refused(changed(lambda parts: parts[0].update(own_elements=3)),
                                 "/parts/0/own_elements", "3 is not 72")
        self.assert_file_refused(changed(lambda parts: parts[0].update(segment=[])), "/parts/0",
                                 'did you mean "segments"')

    def test_a_file_that_is_none_is_refused(self):
        for text in ("", "[]", "7", "null", '{"decomposition": 1}', '{"decomposition": 2}',
                     '{"parts": {}}', "{" * 100000, "[" * 100000, "\xff\x00"):
            self.assert_file_refused(text)
        head = {"decomposition": 1, "elements": 144, "rows": 12}
        for parts in ([], {}, 3, None, [[]], [{}], [{"segments": 4}], [{"segments": [[]]}], [{
                "segments": [{}]
        }], [{"segments": [[0, 0]]}]):
            self.assert_file_refused({**head, "parts": parts}, "/parts")
        self.assert_file_refused('{\n"decomposition": 1,,}', "line 2, column 20")
        self.assert_file_refused('{"elements": 1e999}', "too large")
        self.assert_refused(2, ["missing.json"], *PLATE, "--from", self.path("missing.json"))

    def test_a_damaged_file_is_read_or_refused_and_nothing_else(self):
        generator = random.Random(1)
        good = json.dumps(self.plate_file())
        for _ in range(60):
            place = generator.randrange(len(good))
            damaged = good[:place] + generator.choice(
                '0123456789[]{},:"-e') + good[place + generator.randrange(3):]
            result = dssbench(*PLATE, "--from", self.write("bad.json", damaged))
            self.assertIn(result.returncode, (0, 2), damaged[max(0, place - 40):place + 40])
            self.assertEqual(result.stderr.count("\n"), 1 if result.returncode else 0,
                             result.stderr)

    def test_bad_arguments_are_refused_with_what_would_be_right(self):
        self.assert_refused(2, ["--parts 0", "1 or more"], *PLATE)
        self.assert_refused(2, ["blokcs", '"blocks"'], *PLATE, "--parts", "2", "--method", "blokcs")
        self.assert_refused(2, ["12 rows", "at most 12"], *PLATE, "--parts", "13")
        self.assert_refused(2, ["144 elements", "at most 144"], *PLATE, "--parts", "145",
                            "--method", "blocks")
        self.assert_refused(2, ["--depth -1", "0 to 255"], *PLATE, "--parts", "2", "--depth=-1")
        self.assert_refused(2, ["2 speeds for 3 parts"], *PLATE, "--parts", "3", "--speeds", "1,1")
        self.assert_refused(2, ["--speeds", "-1"], *PLATE, "--parts", "2", "--speeds=-1,1")
        self.assert_refused(2, ["--from", "--parts"], *PLATE, "--parts", "2", "--from",
                            self.path("x.json"))
        self.assert_refused(2, ["no/x.json", "No such file"], *PLATE, "--parts", "2", "--output",
                            self.path("no/x.json"))

    @unittest.skipIf(HAS_METIS, "this build has METIS")
    def test_a_build_without_metis_says_so(self):
        self.assert_refused(2, ["built without METIS", "libmetis-dev"], *PLATE, "--parts", "2",
                            "--method", "metis")

    def test_help_has_an_example(self):
        self.assertIn("Example: dssbench decompose", dssbench("decompose", "--help").stdout)

    def test_a_picture_comes_of_a_file(self):
        for arguments in (
            (*PLATE, "--parts", "40", "--method", "blocks"),
            ("decompose", "two_bodies", "--parts", "4"),
            ("decompose", "l_bracket", "--parts", "3"),
        ):
            self.file_of(*arguments)
            result = self.draw("parts.json")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertGreater(os.path.getsize(self.path("parts.png")), 5000)

    def test_a_picture_of_another_file_is_refused_in_one_line(self):
        self.write("other.json", '{"parts": []}')
        for name in ("other.json", "missing.json"):
            result = self.draw(name)
            self.assertEqual((result.returncode, result.stderr.count("\n")), (1, 1), result.stderr)
            self.assertIn("dssbench decompose", result.stderr)

    def draw(self, name):
        result = subprocess.run(
            [
                sys.executable,
                ROOT / "plots/decomposition_picture.py", self.path(name), "-o",
                self.path("parts.png"),
            ],
            capture_output=True,
            text=True,
        )
        if "ModuleNotFoundError" in result.stderr:
            self.skipTest("this python has no matplotlib")
        return result


if __name__ == "__main__":
    unittest.main()
