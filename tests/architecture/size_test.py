"""Sizes that a reader can see at once: lines of 100 columns, functions of 60 lines."""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = ("cmake", "examples", "experiments", "kernels", "plots", "python", "solver", "tests",
           "variants")
SOURCES = (".h", ".hpp", ".cpp", ".cl", ".py", ".cmake", ".sh", ".in", ".js", ".css")
COLUMNS, LINES = 100, 60
EXCEPTIONS = {
    # Lists, whose entries a reader looks up one by one.
    "kernels/cases.hpp": "kernel_cases", "variants/opencl/opencl.cpp": "status_name",
    # The hot loop. Its machine code changes with each cut.
    "kernels/stage_row/stage_row.hpp": "run",
}


def sources():
    """All source files, as paths from the root."""
    return [path.relative_to(ROOT).as_posix() for folder in FOLDERS
            for path in sorted((ROOT / folder).rglob("*"))
            if path.suffix in SOURCES and "__pycache__" not in path.parts]


def long_functions(files, root):
    """(lines, file, function) of the functions that are longer than LINES, by Universal Ctags."""
    listed = subprocess.run(
        ["ctags", "--fields=+ne", "--languages=C++,Python", "--kinds-C++=f", "--kinds-Python=fm",
         "--langmap=C++:+.cl.h", "-o", "-", *files],
        cwd=root, capture_output=True, text=True, check=True).stdout
    for line in listed.splitlines():
        if found := re.search(r"\tline:(\d+).*\tend:(\d+)", line):
            name, file = line.split("\t")[:2]
            length = int(found[2]) - int(found[1]) + 1
            if length > LINES:
                yield length, file, name


def why_no_ctags():
    """Why functions cannot be measured here; empty if they can."""
    if not shutil.which("ctags"):
        return "there is no ctags (universal-ctags)"
    version = subprocess.run(["ctags", "--version"], capture_output=True, text=True).stdout
    return "" if "Universal" in version else "ctags is not Universal Ctags"


class Sizes(unittest.TestCase):
    maxDiff = None

    def test_lines_have_at_most_100_columns(self):
        files = sources()
        self.assertGreater(len(files), 500)
        wide = [f"{file}:{number}" for file in files
                for number, line in enumerate((ROOT / file).read_text("utf-8").splitlines(), 1)
                if len(line) > COLUMNS]
        self.assertEqual(wide, [])

    @unittest.skipIf(why_no_ctags(), why_no_ctags())
    def test_functions_have_at_most_60_lines(self):
        found = {file: name for _, file, name in long_functions(sources(), ROOT)}
        self.assertEqual(found, EXCEPTIONS)

    @unittest.skipIf(why_no_ctags(), why_no_ctags())
    def test_a_long_function_is_found(self):
        with tempfile.TemporaryDirectory() as folder:
            body = "  f();\n" * LINES
            pathlib.Path(folder, "a.cpp").write_text("void g() {\n" + body + "}\n", "utf-8")
            self.assertEqual(list(long_functions(["a.cpp"], folder)), [(LINES + 2, "a.cpp", "g")])


if __name__ == "__main__":
    sys.exit(unittest.main())
