"""The layers hold: a file includes its own layer and the layers before it, and no circle of units.

A unit is a header with its source. HACKING.md and experiments/README.md show the layers.
"""
import pathlib
import re
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
LAYERS = [
    "kernels", "solver", "variants", "experiments/base", "experiments/run", "experiments/measure",
    "experiments/studies", "experiments/cli", "python"
]
SOURCES = (".h", ".hpp", ".cpp", ".cl")
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)
# experiments/base knows of no solver. Of the layers before it, it may include only these.
FOR_BASE = ("solver/error.hpp", "solver/nearest_name.hpp", "solver/io/atomic_file.hpp",
            "solver/io/temporaries.hpp", "solver/cores.hpp", "solver/parallel.hpp")


def layer_of(path):
    """Index of a file's layer in LAYERS, or None."""
    return next((n for n, layer in enumerate(LAYERS) if path.startswith(layer + "/")), None)


def kind_of(path):
    """The kind of study that a file belongs to, or None."""
    parts = path.split("/")
    return parts[2] if parts[:2] == ["experiments", "studies"] and len(parts) > 3 else None


def includes(root):
    """Yields (file, included file) for all sources of the layers, as paths from the root."""
    for layer in LAYERS:
        for path in sorted((root / layer).rglob("*")):
            if path.suffix not in SOURCES:
                continue
            for target in INCLUDE.findall(path.read_text(encoding="utf-8")):
                if (root / target).exists():
                    yield path.relative_to(root).as_posix(), target


def wrong_directions(pairs):
    """Includes of a later layer, of the solver by base, or of another kind of study."""
    for file, target in pairs:
        here, there = layer_of(file), layer_of(target)
        if there is None or there > here:
            yield f"{file} includes {target}, of a later layer"
        if LAYERS[here] == "experiments/base" and there < here and target not in FOR_BASE:
            yield f"{file} includes {target}: base knows of no solver"
        if kind_of(file) and kind_of(target) and kind_of(file) != kind_of(target):
            yield (f"{file} includes {target}, of another kind of study: put what both need into "
                   "measure")


def unit_of(path):
    return path.rsplit(".", 1)[0]


def circles(pairs):
    """Circles of units that include each other, each once, as a chain of names."""
    graph = {}
    for file, target in pairs:
        if unit_of(file) != unit_of(target):
            graph.setdefault(unit_of(file), set()).add(unit_of(target))
    done, path = set(), []

    def visit(unit):
        if unit in path:
            yield " -> ".join(path[path.index(unit):] + [unit])
            return
        if unit in done:
            return
        path.append(unit)
        for other in sorted(graph.get(unit, ())):
            yield from visit(other)
        path.pop()
        done.add(unit)

    for unit in sorted(graph):
        yield from visit(unit)


class Includes(unittest.TestCase):
    maxDiff = None

    def test_no_include_runs_to_a_later_layer(self):
        pairs = list(includes(ROOT))
        self.assertGreater(len(pairs), 1000)
        self.assertEqual(list(wrong_directions(pairs)), [])

    def test_no_units_include_each_other_in_a_circle(self):
        self.assertEqual(list(circles(includes(ROOT))), [])


class Planted(unittest.TestCase):
    """The rules find what breaks them."""

    def found(self, rule, files):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in files.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text, encoding="utf-8")
            return list(rule(includes(root)))

    def test_an_upward_include_is_found(self):
        files = {"kernels/a.hpp": '#include "solver/b.hpp"\n', "solver/b.hpp": "",
                 "experiments/base/c.cpp": '#include "solver/b.hpp"\n',
                 "experiments/studies/x/x.cpp": '#include "experiments/studies/y/y.hpp"\n',
                 "experiments/studies/y/y.hpp": "#pragma once\n"}
        found = self.found(wrong_directions, files)
        self.assertEqual(len(found), 3, found)
        self.assertIn("kernels/a.hpp includes solver/b.hpp", found[0])

    def test_a_circle_through_a_source_is_found(self):
        files = {"solver/a.hpp": '#include "solver/b.hpp"\n', "solver/b.hpp": "",
                 "solver/b.cpp": '#include "solver/b.hpp"\n#include "solver/c.hpp"\n',
                 "solver/c.hpp": '#include "solver/a.hpp"\n'}
        found = self.found(circles, files)
        self.assertEqual(found, ["solver/a -> solver/b -> solver/c -> solver/a"])


if __name__ == "__main__":
    sys.exit(unittest.main())
