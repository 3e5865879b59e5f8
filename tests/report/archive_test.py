"""Tests the archive: its files, its RO-Crate metadata, and that one commit gives the same bytes."""
import csv
import io
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile

import report

try:
    import pandas  # noqa: F401
except ImportError as missing:
    report.skip_all(f"this python has no {missing.name}")
if subprocess.run(["git", "-C", report.ROOT, "rev-parse"], capture_output=True,
                  check=False).returncode:
    report.skip_all("the tree is no clone of git")


def git(folder, *words):
    """Runs git as someone."""
    who = ("-c", "user.name=test", "-c", "user.email=test@localhost")
    subprocess.run(["git", "-C", folder, *who, *words], check=True, capture_output=True)


class Archive(unittest.TestCase):
    """Archives of a clone with the scripts of this tree."""

    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory(prefix="dssbench-archive-")
        cls.addClassCleanup(holder.cleanup)
        cls.folder = pathlib.Path(holder.name)
        cls.tree = cls.folder / "tree"
        git(report.ROOT, "clone", "--quiet", "--shared", str(report.ROOT), str(cls.tree))
        shutil.copytree(report.ROOT / "plots", cls.tree / "plots", dirs_exist_ok=True)
        git(cls.tree, "add", "--all")
        git(cls.tree, "commit", "--quiet", "--allow-empty", "--message", "the scripts")
        cls.file = cls.folder / "a.zip"
        result = cls.pack(cls.file)
        if result.returncode:
            raise AssertionError(result.stderr)
        cls.archive = zipfile.ZipFile(cls.file)
        cls.addClassCleanup(cls.archive.close)
        cls.crate = json.loads(cls.archive.read("ro-crate-metadata.json"))
        cls.entities = {entity["@id"]: entity for entity in cls.crate["@graph"]}

    @classmethod
    def pack(cls, output, **more):
        script = cls.tree / "plots" / "make_archive.py"
        return subprocess.run([sys.executable, script, output], capture_output=True, text=True,
                              check=False, env={**os.environ, **more})

    def test_all_committed_files_are_there(self):
        names = subprocess.run(["git", "-C", self.tree, "ls-files"], capture_output=True,
                               text=True, check=True).stdout.split("\n")
        self.assertLessEqual({name for name in names if name}, set(self.archive.namelist()))

    def test_every_reference_leads_to_an_entity_or_a_page(self):
        def references(value):
            if isinstance(value, list):
                for one in value:
                    yield from references(one)
            elif isinstance(value, dict):
                yield value["@id"]
        found = 0
        for entity in self.crate["@graph"]:
            for key, value in entity.items():
                for name in references(value):
                    found += 1
                    self.assertTrue(name in self.entities or key == "conformsTo",
                                    f"{entity['@id']}: {key}: {name}")
        self.assertGreater(found, 100)
        self.assertEqual(len(self.entities), len(self.crate["@graph"]))

    def test_files_and_folders_that_it_names_are_in_the_archive(self):
        names = self.archive.namelist()
        for entity in self.crate["@graph"]:
            if entity["@type"] == "File":
                self.assertIn(entity["@id"], names)
            elif entity["@type"] == "Dataset" and entity["@id"] != "./":
                self.assertTrue(any(name.startswith(entity["@id"]) for name in names))

    def test_a_study_names_its_program_its_input_and_its_results(self):
        action = self.entities["#results/table1"]
        self.assertEqual(action["object"], {"@id": "experiments/studies/speedup/table1.json"})
        results = [one["@id"] for one in action["result"]]
        self.assertIn("results/raw/table1.csv", results)
        self.assertIn("results/tables/table1.csv", results)
        with self.archive.open("results/raw/table1.csv") as file:
            last = max(row["time_utc"] for row in csv.DictReader(io.TextIOWrapper(file)))
        self.assertEqual(action["endTime"][:19], last[:19])
        record = json.loads(self.archive.read("results/raw/table1.json"))
        self.assertEqual(self.entities[action["instrument"]["@id"]]["softwareVersion"],
                         record["context"]["git_commit"])

    def test_one_commit_gives_the_same_bytes(self):
        other = self.folder / "b.zip"
        self.assertEqual(self.pack(other, TZ="Asia/Tokyo").returncode, 0)
        self.assertEqual(self.file.read_bytes(), other.read_bytes())

    def fails(self, output, words):
        """The command fails with one line, and leaves nothing."""
        before = set(self.folder.iterdir())
        result = self.pack(output)
        self.assertNotEqual(result.returncode, 0)
        self.assertIn(words, result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.assertEqual(set(self.folder.iterdir()), before)

    def test_bad_places_are_refused(self):
        self.fails(self.folder / "missing" / "c.zip", "No such file or directory")

    def test_changes_that_are_not_committed_are_refused(self):
        page = self.tree / "README.md"
        text = page.read_text(encoding="utf-8")
        page.write_text(text + "\n", encoding="utf-8")
        self.addCleanup(page.write_text, text, encoding="utf-8")
        self.fails(self.folder / "c.zip", "not committed")

    def test_a_record_that_cannot_be_read_is_no_archive(self):
        record = self.tree / "results" / "raw" / "table1.json"
        record.write_text('{"context": {}}', encoding="utf-8")
        git(self.tree, "commit", "--quiet", "--all", "--message", "a bad record")
        self.addCleanup(git, self.tree, "reset", "--quiet", "--hard", "HEAD~1")
        self.fails(self.folder / "c.zip", "cannot be read")


if __name__ == "__main__":
    unittest.main()
