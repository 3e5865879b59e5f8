"""Every code cell of every notebook runs, and every block of the page about Python."""
import contextlib
import io
import json
import pathlib
import re
import tempfile
import unittest

import matplotlib
matplotlib.use("Agg")

ROOT = pathlib.Path(__file__).resolve().parents[2]
NOTEBOOKS = ROOT / "python" / "notebooks"


def run_all(sources, path):
    """Runs pieces of code one after the other in a scratch folder that has the results."""
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder), \
            contextlib.redirect_stdout(io.StringIO()):
        pathlib.Path("results").symlink_to(ROOT / "results")
        names = {}
        for source in sources:
            exec(compile(source, str(path), "exec"), names)  # pylint: disable=exec-used


class Page(unittest.TestCase):
    def test_every_block_runs(self):
        path = ROOT / "docs" / "13_python.md"
        blocks = re.findall(r"```python\n(.*?)```", path.read_text(), re.DOTALL)
        self.assertGreaterEqual(len(blocks), 4)
        run_all(blocks, path)


class Notebooks(unittest.TestCase):
    def test_every_cell_runs(self):
        paths = sorted(NOTEBOOKS.glob("*.ipynb"))
        self.assertGreaterEqual(len(paths), 2)
        for path in paths:
            notebook = json.loads(path.read_text())
            self.assertEqual(notebook["nbformat"], 4)
            with self.subTest(path.name):
                run_all(["".join(cell["source"]) for cell in notebook["cells"]
                         if cell["cell_type"] == "code"], path)

    def test_no_output_is_committed(self):
        # it would be of another machine, and nobody would draw it anew
        for path in NOTEBOOKS.glob("*.ipynb"):
            for cell in json.loads(path.read_text())["cells"]:
                self.assertFalse(cell.get("outputs"), path)


if __name__ == "__main__":
    unittest.main()
