"""Results as tables, and figures of them."""
import pathlib
import tempfile
import unittest

import matplotlib
matplotlib.use("Agg")

import dssbench  # noqa: E402
from dssbench import plots  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
STUDY = {
    "experiment": "own",
    "title": "Two variants on a small plate",
    "cells": [{"scene": "plate_paper", "set": {"n": [8, 12]}, "variants": ["reference", "scalar"],
               "threads": [1]}],
    "base": ["reference"],
    "twin": "scalar",
    "scales": {"smoke": {"steps": 40, "oracle_steps": 20, "repetitions": [2, 2], "retries": 0,
                         "budget_s": 60, "time_limit_s": 20}},
}


class Shipped(unittest.TestCase):
    def test_every_table_loads(self):
        results = dssbench.load(ROOT / "results")
        self.assertIn("table1", results.names())
        for name in results.names():
            self.assertGreater(len(results.table(name).columns), 0, name)

    def test_columns_have_units(self):
        results = dssbench.load(ROOT / "results")
        records, table = (results.raw("table1").attrs["units"],
                          results.table("table1").attrs["units"])
        self.assertEqual(records["wall_s"], "s")
        self.assertEqual(table["measured_wall_s"], "s")
        for column, unit in {**records, **table}.items():
            self.assertEqual(column.endswith("_per_s"), unit.endswith("/s"), (column, unit))

    def test_circumstances_say_how_it_was_measured(self):
        self.assertIn("sources", dssbench.load(ROOT / "results").circumstances("table1"))

    def test_mistakes_are_refused(self):
        with self.assertRaisesRegex(dssbench.InputError, "no folder tables"):
            dssbench.load(ROOT)
        with self.assertRaisesRegex(dssbench.InputError, "there is no such file"):
            dssbench.load(ROOT / "results").table("table9")


class Measured(unittest.TestCase):
    def test_a_study_from_a_dict_is_measured_and_drawn(self):
        with tempfile.TemporaryDirectory() as folder:
            results = dssbench.experiment(STUDY, pathlib.Path(folder) / "out", scale="smoke")
            raw = results.raw("own")
            axes = plots.lines(raw, "elements", "wall_s", by="variant")
            self.assertEqual(results.names(), ["own"])
        self.assertGreaterEqual(len(raw), 8)
        self.assertEqual(axes.get_ylabel(), "wall_s [s]")
        self.assertEqual(len(axes.get_legend().get_texts()), 2)

    def test_a_history_has_units(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "history.csv"
            dssbench.run("plate_paper", set={"n": 8}, steps=10, history=file, variant="scalar",
                         probe="corner=plate,0.01,0.01,0")
            history = dssbench.read_history(file)
        units = history.attrs["units"]
        self.assertEqual((units["t"], units["energy"], units["corner.ux"], units["corner.sxx"]),
                         ("s", "J", "m", "Pa"))
        self.assertNotIn("step", units)

    def test_a_body_is_drawn(self):
        simulation = dssbench.Simulation("plate_paper", set={"n": 8}, variant="scalar")
        simulation.advance(5)
        axes = plots.body(simulation)
        self.assertEqual(len(axes.collections[0].get_offsets()), 64)


if __name__ == "__main__":
    unittest.main()
