"""Tests the check of figures: it finds planted violations, and it passes every committed table."""
import pathlib
import sys
import tempfile
import unittest
import unittest.mock
import zlib

import report

try:
    import matplotlib
    import pandas
except ImportError as missing:
    report.skip_all(f"this python has no {missing.name}")
matplotlib.use("Agg")
sys.path.insert(0, str(report.ROOT / "plots"))
import matplotlib.pyplot as plt  # noqa: E402
import make_plots  # noqa: E402
import numpy  # noqa: E402
from charts import CHARTS, Entry, figures_of  # noqa: E402
from description import Axis, Chart, Look, Panel, Series  # noqa: E402
from render import check, page, pictures, png  # noqa: E402
from tables.results import Results  # noqa: E402

# Pictures of bodies, not of tables.
FIELDS = {"arm", "l_bracket", "l_bracket_frames", "plate_paper"}


def chart_of(series, heading="A chart"):
    """A chart with these series only."""
    axes = Axis("x [m]"), Axis("y [m]")
    return Chart("a_table", series[0].rows, {}, [Panel(*axes, series)], heading)


def series_of(name, look, values=(1, 2, 3)):
    """A series of three points."""
    rows = pandas.DataFrame({"x": [1, 2, 3], "y": values, "line": [2, 3, 4]})
    return Series(name, rows, "x", "y", look)


def write_body(path, moved):
    """Writes two elements side by side, in the format of `dssbench run --output`."""
    corners = numpy.array([[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))])
    points = numpy.concatenate([corners, corners + [1, 0, 0]]).astype("<f8")
    arrays = {"Points": ("points", points, 3),
              "Cells": ("connectivity", numpy.arange(16), 1),
              "PointData": ("displacement", moved * points, 3),
              "CellData": ("von_mises", numpy.array([1e6, 2e6]), 1)}
    parts, appended = [], b""
    for section, (name, values, count) in arrays.items():
        kind = "Int64" if section == "Cells" else "Float64"
        raw = values.astype("<i8" if section == "Cells" else "<f8").tobytes()
        parts.append(f'<{section}><DataArray type="{kind}" Name="{name}" '
                     f'NumberOfComponents="{count}" offset="{len(appended)}"/></{section}>')
        blocks = [zlib.compress(raw[:80]), zlib.compress(raw[80:])] if len(raw) > 80 else [
            zlib.compress(raw)]
        words = [len(blocks), 80, len(raw) % 80, *map(len, blocks)]
        appended += numpy.array(words, dtype="<u8").tobytes() + b"".join(blocks)
    head = f"<VTKFile><Piece>{''.join(parts)}</Piece>".encode("utf-8")
    path.write_bytes(head + b'<AppendedData encoding="raw">\n_' + appended
                     + b"</AppendedData></VTKFile>")


class Planted(unittest.TestCase):
    """The check finds planted violations."""

    def setUp(self):
        self.figure, self.axes = plt.subplots()
        self.addCleanup(plt.close, self.figure)

    def only_violation(self):
        """The one violation of the figure."""
        found = check.violations(self.figure)
        self.assertEqual(len(found), 1, found)
        return found[0]

    def test_a_plain_figure_has_none(self):
        self.axes.plot([1, 2], [1, 2], "o", gid="a")
        self.axes.plot([1, 2], [2, 1], "s", gid="b")
        self.assertEqual(check.violations(self.figure), [])

    def test_text_beyond_each_side_of_the_canvas(self):
        for side, place in (("left", (-0.1, 0.5)), ("right", (1.1, 0.5)), ("lower", (0.5, -0.1)),
                            ("upper", (0.5, 1.1))):
            text = self.figure.text(*place, "cut off", ha="center", va="center")
            self.assertRegex(self.only_violation(), rf'text "cut off" reaches \d+ pixels beyond '
                                                    rf"the {side} edge of the canvas; wrap it")
            text.remove()

    def test_a_title_that_is_too_long(self):
        self.axes.set_title("a title of many words " * 8)
        self.assertIn("of many words", self.only_violation())

    def test_a_hidden_text_and_a_tick_outside_of_the_limits_are_none(self):
        self.figure.text(2, 2, "hidden", visible=False)
        self.axes.set_xticks([0, 1, 50], ["0", "1", "a label far away"])
        self.axes.set_xlim(0, 1)
        self.assertEqual(check.violations(self.figure), [])

    def test_a_legend_over_points_over_a_line_and_over_a_bar(self):
        for draw in (lambda: self.axes.plot([0, 1], [0, 1], "o", label="marks"),
                     lambda: self.axes.plot([0, 1], [0, 1], label="a line"),
                     lambda: self.axes.bar([0, 1], [1, 1], label="bars")):
            draw()
            self.axes.legend(loc="upper right", borderaxespad=0)
            self.axes.margins(0.01)
            self.assertRegex(self.only_violation(), 'the legend ".*" covers data of .*; place it '
                                                    "outside of the axes")
            self.axes.clear()

    def test_a_legend_over_a_label(self):
        self.axes.set(xlim=(0, 1), ylim=(0, 1))
        self.axes.text(0.5, 0.5, "the label of a bar")
        self.axes.plot([], [], label="entry")
        self.axes.legend(loc="center")
        self.assertIn('covers the text "the label of a bar"', self.only_violation())

    def test_two_series_of_one_mark_and_colour(self):
        for name in ("first", "second"):
            self.axes.plot([1, 2], [1, 2], "o", color="#0072B2", gid=name)
        found = self.only_violation()
        self.assertIn('series "first" and "second" have the same mark and colour', found)
        self.assertIn("give each its own", found)

    def test_two_series_of_bars_of_one_colour_and_hatch(self):
        for place, (name, hatch) in enumerate((("a", "//"), ("b", "//"), ("c", ""))):
            self.axes.bar([place], [1], color="#0072B2", hatch=hatch, gid=name)
        self.assertIn('series "a" and "b"', self.only_violation())

    def test_another_line_fill_or_hatch_is_another_look(self):
        for name, line, fill in (("a", "-", "#0072B2"), ("b", ":", "#0072B2"), ("c", "-", "none")):
            self.axes.plot([1, 2], [1, 2], "o", linestyle=line, color="#0072B2",
                           markerfacecolor=fill, gid=name)
        self.assertEqual(check.violations(self.figure), [])

    def test_the_error_names_the_file_which_is_written(self):
        self.figure.text(2, 0.5, "cut off")
        with tempfile.TemporaryDirectory() as directory:
            output = pathlib.Path(directory) / "figures" / "bad.png"
            with self.assertRaisesRegex(check.Unreadable, 'bad.png: text "cut off" reaches'):
                pictures.save(self.figure, output, "")
            self.assertTrue(output.exists())


class Rendered(unittest.TestCase):
    """The PNG renderer makes room for texts and checks the series of a chart."""

    def draw(self, *series, **more):
        """Draws a chart of series."""
        with tempfile.TemporaryDirectory() as directory:
            png.draw([chart_of(series, **more)], pathlib.Path(directory) / "chart.png", "")

    def test_series_of_one_look_are_an_error(self):
        look = Look("#0072B2", "circle")
        with self.assertRaisesRegex(check.Unreadable, 'series "one" and "two" have the same mark'):
            self.draw(series_of("one", look), series_of("two", look))
        self.draw(series_of("one", look), series_of("two", look.but(mark="square")))

    def test_long_headings_and_long_entries_get_their_room(self):
        self.draw(series_of("a series with a name that is longer than most", Look("ink", "circle")),
                  series_of("another", Look("ink", "square")), heading="many words " * 60)

    def test_labels_of_bars_get_their_room(self):
        rows = pandas.DataFrame({"x": [1.0, 9.0], "y": ["short", "long"], "line": [2, 3],
                                 "label": ["1", "9 with many words behind it"]})
        bars = Series("bars", rows, "x", "y", Look(), kind="bars", label="label")
        panel = Panel(Axis("x"), Axis(scale="category", categories=["short", "long"]), [bars])
        with tempfile.TemporaryDirectory() as directory:
            png.draw([Chart("a_table", rows, {}, [panel], "")], pathlib.Path(directory) / "c.png",
                     "")


class Committed(unittest.TestCase):
    """The committed tables."""

    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory(prefix="dssbench-figures-")
        cls.addClassCleanup(holder.cleanup)
        cls.directory = pathlib.Path(holder.name) / "results"
        report.copy_committed(cls.directory)

    def test_every_table_is_drawn_and_every_figure_can_be_read(self):
        for folder in (self.directory, self.directory / "h100"):
            committed = {path.stem for path in (folder / "figures").glob("*.png")} - FIELDS
            for path in (folder / "figures").glob("*.png"):
                path.unlink()
            result = report.make_plots(folder)
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            drawn = {path.stem for path in (folder / "figures").glob("*.png")}
            self.assertEqual(drawn, committed)

    def test_a_column_that_is_empty_in_every_row_may_be_left_out(self):
        reduced = self.directory.parent / "reduced"
        report.copy_committed(reduced)
        report.leave_out_empty_columns(reduced)
        whole, less = Results(self.directory), Results(reduced)
        there = [entry for entry in CHARTS if whole.has(entry.table)]
        # table1_host is no part of a reproduction.
        self.assertEqual({entry.name for entry in CHARTS} - {entry.name for entry in there},
                         {"speedups-1-host"})
        for entry in there:
            specs = [page.spec(entry.make(results)) for results in (whole, less)]
            self.assertEqual(*specs, entry.name)

    def test_a_table_with_odd_values_is_an_error_after_the_others_are_drawn(self):
        sick = self.directory.parent / "sick"
        (sick / "tables").mkdir(parents=True)
        for name in ("stability_energy", "statics"):
            text = (self.directory / "tables" / f"{name}.csv").read_text(encoding="utf-8")
            (sick / "tables" / f"{name}.csv").write_text(text, encoding="utf-8")
        table = pandas.read_csv(sick / "tables" / "stability_energy.csv")
        table["h_omega"] = "not a number"
        table.to_csv(sick / "tables" / "stability_energy.csv", index=False)
        result = report.make_plots(sick)
        self.assertEqual(result.returncode, 1)
        self.assertIn("stability_energy.png cannot be drawn", result.stderr)
        self.assertNotIn("Traceback", result.stderr)
        self.assertTrue((sick / "figures" / "statics.png").exists())

    def test_a_figure_that_cannot_be_read_is_an_error_after_the_others_are_drawn(self):
        alike = [series_of(name, Look("#0072B2", "circle")) for name in ("one", "two")]
        bad = Entry("bad", "Bad", "a_table", lambda results: chart_of(alike), "bad")
        good = Entry("good", "Good", "a_table", lambda results: chart_of(alike[:1]), "good")
        results = Results(self.directory.parent / "planted")
        with unittest.mock.patch("make_plots.figures_of",
                                 return_value={"bad": [bad], "good": [good]}):
            errors = make_plots.draw_all(results)
        self.assertEqual(len(errors), 1)
        self.assertRegex(errors[0], 'bad.png: panel ".*": series "one" and "two" have the same')
        self.assertTrue((results.directory / "figures" / "good.png").exists())

    def test_pictures_of_a_body_can_be_read(self):
        fields = self.directory.parent / "bodies" / "fields"
        fields.mkdir(parents=True)
        for frame in (1, 2, 3):
            write_body(fields / f"beam_{frame}.vtu", 1e-3 * frame)
        states = "".join(f'<DataSet timestep="{0.5 * frame}" file="beam_{frame}.vtu"/>'
                         for frame in (1, 2, 3))
        (fields / "beam.pvd").write_text(f"<VTKFile><Collection>{states}</Collection></VTKFile>",
                                         encoding="utf-8")
        write_body(fields / "alone.vtu", 1e-3)
        result = report.make_plots(fields.parent)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        drawn = {path.stem for path in (fields.parent / "figures").glob("*.png")}
        self.assertEqual(drawn, {"alone", "beam", "beam_frames"})

    def test_charts_of_one_figure_are_of_one_table(self):
        for figure, entries in figures_of(Results(self.directory)).items():
            self.assertEqual(len({entry.table for entry in entries}), 1, figure)


if __name__ == "__main__":
    report.run_tests("__main__")
