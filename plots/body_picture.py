#!/usr/bin/python3
"""Draws a deformed body from a file of `dssbench run --output`, coloured by von Mises stress.

A .vtu file gives one picture. A .pvd file (a series, from --frames) gives two: the last state, and
a strip of states over time in STEM_frames beside it. A body of one layer is seen from +z, any
other body from a slanted direction. The displacements are magnified. No solver runs.
Example: plots/body_picture.py results/fields/l_bracket.pvd --output results/figures/l_bracket.png
"""
import argparse
import dataclasses
import functools
import math
import pathlib
import sys
import xml.etree.ElementTree
import zlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy  # noqa: E402
from matplotlib.collections import PolyCollection  # noqa: E402
from render.check import Unreadable  # noqa: E402
from render.pictures import drawn_now, save  # noqa: E402

TYPES = {"Float64": "<f8", "Int64": "<i8", "Int32": "<i4", "UInt8": "u1"}
# Corners of the faces of a VTK hexahedron, anticlockwise as seen from outside.
FACES = numpy.array([[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4],
                     [2, 3, 7, 6], [0, 4, 7, 3], [1, 2, 6, 5]])
# The slanted view is turned about y, then about x.
YAW, PITCH = math.radians(-28), math.radians(24)
STRIP = 6  # largest number of frames
STRIP_COLUMNS = 3


def inflated(data, offset):
    """An array of appended data: a header of 64-bit words, then blocks of zlib."""
    blocks = int.from_bytes(data[offset:offset + 8], "little")
    words = numpy.frombuffer(data, "<u8", 3 + blocks, offset)
    ends = offset + words.nbytes + numpy.cumsum(words[3:], dtype=numpy.int64)
    starts = ends - words[3:].astype(numpy.int64)
    return b"".join(zlib.decompress(data[start:end]) for start, end in zip(starts, ends))


def read_vtu(path):
    """Arrays of a .vtu with compressed appended data, by (section, name)."""
    head, _, tail = pathlib.Path(path).read_bytes().partition(b"<AppendedData")
    data = tail[tail.index(b"_") + 1:]
    root, arrays = xml.etree.ElementTree.fromstring(head + b"</VTKFile>"), {}
    for section in ("Points", "Cells", "PointData", "CellData"):
        for node in root.iterfind(f".//Piece/{section}/DataArray"):
            raw = inflated(data, int(node.get("offset")))
            values = numpy.frombuffer(raw, TYPES[node.get("type")])
            components = int(node.get("NumberOfComponents"))
            arrays[section, node.get("Name")] = (
                values.reshape(-1, components) if components > 1 else values)
    return arrays


class Body:
    """One state: the corners of the elements at rest, their displacements, and the stresses."""

    def __init__(self, path):
        arrays = read_vtu(path)
        corners = arrays["Cells", "connectivity"].reshape(-1, 8)
        self.rest = arrays["Points", "points"][corners]
        self.moved = arrays["PointData", "displacement"][corners]
        self.stress = arrays["CellData", "von_mises"]
        self.extent = float(numpy.ptp(self.rest, axis=(0, 1)).max())
        self.largest = float(numpy.abs(self.moved).max())
        self.is_flat = len(numpy.unique(self.rest[:, 0, 2])) == 1

    def view(self):
        """The rotation to the view: its rows point right, up and towards the viewer."""
        if self.is_flat:
            return numpy.eye(3)
        about_y = numpy.array([[math.cos(YAW), 0, math.sin(YAW)],
                               [0, 1, 0],
                               [-math.sin(YAW), 0, math.cos(YAW)]])
        about_x = numpy.array([[1, 0, 0],
                               [0, math.cos(PITCH), -math.sin(PITCH)],
                               [0, math.sin(PITCH), math.cos(PITCH)]])
        return about_x @ about_y

    def faces(self, magnification):
        """Polygons of the visible faces, back to front, and the element of each."""
        centres = numpy.round(self.rest[:, FACES].mean(axis=2).reshape(-1, 3) / self.extent, 9)
        _, place, count = numpy.unique(centres, axis=0, return_inverse=True, return_counts=True)
        is_outer = count[place.ravel()] == 1  # two elements share an inner face
        moved = (self.rest + magnification * self.moved)[:, FACES].reshape(-1, 4, 3)
        corners = (moved @ self.view().T)[is_outer]
        elements = numpy.repeat(numpy.arange(len(self.rest)), len(FACES))[is_outer]
        across = numpy.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
        is_seen = across[:, 2] > 1e-9 * numpy.linalg.norm(across, axis=1).max()
        corners, elements = corners[is_seen], elements[is_seen]
        order = numpy.argsort(corners[:, :, 2].mean(axis=1), kind="stable")
        return corners[order, :, :2], elements[order]


def magnification_of(bodies, wanted):
    """The wanted factor. Default: the largest displacement of all states is 8 % of the body."""
    largest = max(body.largest for body in bodies)
    if wanted is not None:
        return wanted
    return 0.08 * bodies[0].extent / largest if largest > 0 else 1


@dataclasses.dataclass
class StressScale:
    """The scale of colours: its upper end [Pa], the unit in Pa, and its label."""
    highest: float
    unit: float
    label: str


def scale_of(bodies):
    """One scale for several states, up to the 99th percentile of all stresses.

    A few elements at loads and clamps carry several times the stress of the others. A scale up to
    their stress would give the rest of the body one colour.
    """
    stress = numpy.concatenate([body.stress for body in bodies])
    units = [(1e9, "GPa"), (1e6, "MPa"), (1e3, "kPa")]
    unit, name = next((one for one in units if stress.max() >= one[0]), (1, "Pa"))
    label = f"von Mises stress [{name}], largest {stress.max() / unit:.3g}"
    return StressScale(float(numpy.percentile(stress, 99)), unit, label)


def draw_body(axes, body, magnification, scale):
    """Draws one state on `axes`. @returns its faces, for the bar of colours"""
    corners, elements = body.faces(magnification)
    faces = PolyCollection(corners, array=body.stress[elements] / scale.unit, cmap="cividis",
                           edgecolors="face" if body.is_flat else "#00000055", linewidths=0.3)
    faces.set_clim(0, scale.highest / scale.unit or 1)
    axes.add_collection(faces)
    axes.autoscale_view()
    axes.set_aspect("equal")
    return faces


def write(figure, output):
    """Checks and writes a figure that no record is behind."""
    save(figure, output, drawn_now(), dpi=130)
    plt.close(figure)


def draw(path, output, wanted):
    """Draws one state. @returns the files written"""
    body = Body(path)
    magnification, scale = magnification_of([body], wanted), scale_of([body])
    figure, axes = plt.subplots(figsize=(7.5, 6), layout="constrained")
    faces = draw_body(axes, body, magnification, scale)
    if body.is_flat:
        axes.set_xlabel("x [m]")
        axes.set_ylabel("y [m]")
    else:
        axes.set_axis_off()  # in the slanted view no axis has the coordinates of the body
    axes.set_title(f"{len(body.stress)} elements; displacements x {magnification:.3g} "
                   f"(largest {body.largest:.3g} m)", fontsize=10)
    figure.colorbar(faces, ax=axes, label=scale.label, extend="max")
    write(figure, output)
    return [output]


def states_of(series):
    """(time, file) of each state that a .pvd lists."""
    root = xml.etree.ElementTree.parse(series).getroot()
    return [(float(node.get("timestep")), series.parent / node.get("file"))
            for node in root.iter("DataSet")]


def frames_of(states):
    """At most STRIP states at equal distances; the last state is among them."""
    count = min(STRIP, len(states) - 1)
    if count == 0:
        return states
    return [states[round(place * (len(states) - 1) / count)] for place in range(1, count + 1)]


def draw_strip(states, output, wanted):
    """Draws states over time with one magnification and one scale of colours."""
    shown = frames_of(states)
    bodies = [Body(path) for _, path in shown]
    magnification, scale = magnification_of(bodies, wanted), scale_of(bodies)
    rows = math.ceil(len(bodies) / STRIP_COLUMNS)
    figure, panels = plt.subplots(rows, STRIP_COLUMNS, figsize=(9, 0.7 + 2.4 * rows), sharex=True,
                                  sharey=True, squeeze=False, layout="constrained")
    for axes in panels.flat:
        axes.set_axis_off()
    for axes, (time, _), body in zip(panels.flat, shown, bodies):
        faces = draw_body(axes, body, magnification, scale)
        axes.set_title(f"{1e3 * time:.3g} ms, largest {body.largest:.2g} m", fontsize=9)
    figure.suptitle(f"displacements x {magnification:.3g}", fontsize=9, x=0.01, ha="left")
    figure.colorbar(faces, ax=panels, label=scale.label, extend="max")
    write(figure, output)


def draw_series(series, output, wanted):
    """Draws the last state of a .pvd, and a strip of its states. @returns the files written"""
    states = states_of(series)
    strip = output.with_name(f"{output.stem}_frames{output.suffix}")
    draw(states[-1][1], output, wanted)
    draw_strip(states, strip, wanted)
    return [output, strip]


DRAW = {".vtu": draw, ".pvd": draw_series}


def pictures_of(fields, figures):
    """(file, function that draws it) of each .pvd, and of each .vtu that no .pvd lists."""
    series = sorted(fields.glob("*.pvd"))
    listed = {path for file in series for _, path in states_of(file)}
    for path in series + sorted(set(fields.glob("*.vtu")) - listed):
        output = figures / f"{path.stem}.png"
        yield output, functools.partial(DRAW[path.suffix], path, output, None)


def main():
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=pathlib.Path,
                        help=".vtu of `dssbench run --output`, or its .pvd with --frames")
    parser.add_argument("--output", type=pathlib.Path, required=True, help="PNG, SVG or PDF")
    parser.add_argument("--magnification", type=float,
                        help="factor of the displacements (default: the largest displacement "
                             "becomes 8 %% of the body)")
    arguments = parser.parse_args()
    path = arguments.file
    if not path.exists():
        sys.exit(f"{path}: no such file; make it with `dssbench run SCENE --output FILE.vtu` "
                 "(with --frames: FILE.pvd)")
    if path.suffix not in DRAW:
        sys.exit(f"{path}: neither a .vtu nor a .pvd")
    try:
        print(*DRAW[path.suffix](path, arguments.output, arguments.magnification), sep="\n")
    except Unreadable as fault:
        sys.exit(str(fault))


if __name__ == "__main__":
    main()
