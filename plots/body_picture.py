#!/usr/bin/python3
"""Pictures of a body from what `dssbench run --output` writes: deformed (magnified), coloured by von Mises stress.

Of a .vtu one picture. Of a .pvd (a series, from --frames) the last state, and beside it OUTPUT's stem + _frames: states over time in one strip, on one scale.
A body of one layer is seen from +z, any other one aslant. Reads the files and nothing else; never runs a solver.
Example: plots/body_picture.py results/fields/l_bracket.pvd --output results/figures/l_bracket.png
"""
import argparse
import base64
import functools
import math
import pathlib
import sys
import xml.etree.ElementTree

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy  # noqa: E402
from matplotlib.collections import PolyCollection  # noqa: E402
from render.check import Unreadable  # noqa: E402
from render.pictures import drawn_now, save  # noqa: E402

TYPES = {"Float64": "<f8", "Int64": "<i8", "UInt8": "u1"}
# Corners of the faces of a VTK hexahedron, anticlockwise as seen from outside.
FACES = numpy.array([[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [2, 3, 7, 6], [0, 4, 7, 3], [1, 2, 6, 5]])
YAW, PITCH = math.radians(-28), math.radians(24)  # of the slanted view: turned about y, then about x
STRIP = 6  # frames at most


def read_vtu(path):
    """Arrays of a .vtu with inline base64 data, by (section, name)."""
    arrays = {}
    for section in ("Points", "Cells", "PointData", "CellData"):
        for node in xml.etree.ElementTree.parse(path).getroot().iterfind(f".//Piece/{section}/DataArray"):
            data = base64.b64decode(node.text)
            values = numpy.frombuffer(data, TYPES[node.get("type")], offset=8)
            assert values.nbytes == int.from_bytes(data[:8], "little"), f"{path}: {node.get('Name')} is cut off"
            components = int(node.get("NumberOfComponents"))
            arrays[section, node.get("Name")] = values.reshape(-1, components) if components > 1 else values
    return arrays


class Body:
    """One state: its outer faces, where they are, and the stress of their elements."""

    def __init__(self, path):
        arrays = read_vtu(path)
        self.rest, self.moved = arrays["Points", "points"].reshape(-1, 8, 3), arrays["PointData", "displacement"].reshape(-1, 8, 3)
        self.stress = arrays["CellData", "von_mises"]
        self.extent, self.largest = float(numpy.ptp(self.rest, axis=(0, 1)).max()), float(numpy.abs(self.moved).max())
        self.is_flat = len(numpy.unique(self.rest[:, 0, 2])) == 1

    def view(self):
        """Rows are right, up and towards the viewer."""
        if self.is_flat:
            return numpy.eye(3)
        turn = numpy.array([[math.cos(YAW), 0, math.sin(YAW)], [0, 1, 0], [-math.sin(YAW), 0, math.cos(YAW)]])
        return numpy.array([[1, 0, 0], [0, math.cos(PITCH), -math.sin(PITCH)], [0, math.sin(PITCH), math.cos(PITCH)]]) @ turn

    def faces(self, magnification):
        """Polygons that are seen, back to front, and the element of each."""
        centres = numpy.round(self.rest[:, FACES].mean(axis=2).reshape(-1, 3) / self.extent, 9)
        _, place, count = numpy.unique(centres, axis=0, return_inverse=True, return_counts=True)
        is_outer = count[place.ravel()] == 1  # two elements share an inner one
        corners = ((self.rest + magnification * self.moved)[:, FACES].reshape(-1, 4, 3) @ self.view().T)[is_outer]
        elements = numpy.repeat(numpy.arange(len(self.rest)), len(FACES))[is_outer]
        across = numpy.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
        is_seen = across[:, 2] > 1e-9 * numpy.linalg.norm(across, axis=1).max()
        corners, elements = corners[is_seen], elements[is_seen]
        order = numpy.argsort(corners[:, :, 2].mean(axis=1), kind="stable")
        return corners[order, :, :2], elements[order]


def magnification_of(bodies, wanted):
    """What is asked for, or what makes the largest displacement of all states 8 % of the body."""
    largest = max(body.largest for body in bodies)
    return wanted if wanted is not None else 0.08 * bodies[0].extent / largest if largest > 0 else 1


def draw_body(axes, body, magnification, highest, unit):
    corners, elements = body.faces(magnification)
    faces = PolyCollection(corners, array=body.stress[elements] / unit, cmap="cividis", edgecolors="face" if body.is_flat else "#00000055", linewidths=0.3)
    faces.set_clim(0, highest / unit or 1)
    axes.add_collection(faces)
    axes.autoscale_view()
    axes.set_aspect("equal")
    return faces


def scale_of(bodies):
    """The end of the colours, and their unit. A few elements at loads and clamps carry several times the rest: they must not turn the body into one colour."""
    stress = numpy.concatenate([body.stress for body in bodies])
    unit, name = max(((u, n) for u, n in ((1e9, "GPa"), (1e6, "MPa"), (1e3, "kPa")) if stress.max() >= u), default=(1, "Pa"))
    return float(numpy.percentile(stress, 99)), unit, f"von Mises stress [{name}], largest {stress.max() / unit:.3g}"


def write(figure, output):
    output.parent.mkdir(parents=True, exist_ok=True)
    save(figure, output, drawn_now(), dpi=130)
    plt.close(figure)


def draw(path, output, wanted):
    """One state; returns the files written."""
    body = Body(path)
    magnification = magnification_of([body], wanted)
    highest, unit, label = scale_of([body])
    figure, axes = plt.subplots(figsize=(7.5, 6), layout="constrained")
    faces = draw_body(axes, body, magnification, highest, unit)
    if body.is_flat:
        axes.set_xlabel("x [m]")
        axes.set_ylabel("y [m]")
    else:
        axes.set_axis_off()  # aslant, its coordinates are on no axis
    axes.set_title(f"{len(body.stress)} elements; displacements x {magnification:.3g} (largest {body.largest:.3g} m)", fontsize=10)
    figure.colorbar(faces, ax=axes, label=label, extend="max")
    write(figure, output)
    return [output]


def states_of(series):
    """(time, file) of each state that a .pvd lists."""
    return [(float(node.get("timestep")), series.parent / node.get("file")) for node in xml.etree.ElementTree.parse(series).getroot().iter("DataSet")]


def draw_strip(states, output, wanted):
    """States equally far apart, the last one among them, with one magnification and one scale of colours."""
    count = min(STRIP, len(states) - 1)
    shown = [states[round(place * (len(states) - 1) / count)] for place in range(1, count + 1)] if count else states
    bodies = [Body(path) for _, path in shown]
    magnification = magnification_of(bodies, wanted)
    highest, unit, label = scale_of(bodies)
    columns = 3
    figure, panels = plt.subplots(-(-len(bodies) // columns), columns, figsize=(9, 0.7 + 2.4 * -(-len(bodies) // columns)), sharex=True, sharey=True, squeeze=False,
                                  layout="constrained")
    for axes in panels.flat:
        axes.set_axis_off()
    for axes, (time, _), body in zip(panels.flat, shown, bodies):
        faces = draw_body(axes, body, magnification, highest, unit)
        axes.set_title(f"{1e3 * time:.3g} ms, largest {body.largest:.2g} m", fontsize=9)
    figure.suptitle(f"displacements x {magnification:.3g}", fontsize=9, x=0.01, ha="left")
    figure.colorbar(faces, ax=panels, label=label, extend="max")
    write(figure, output)


def draw_series(series, output, wanted):
    """The last state of a .pvd and a strip of its states; returns the files written."""
    states = states_of(series)
    strip = output.with_name(f"{output.stem}_frames{output.suffix}")
    draw(states[-1][1], output, wanted)
    draw_strip(states, strip, wanted)
    return [output, strip]


def pictures_of(fields, figures):
    """(file, function that draws it) of each .pvd, and of each .vtu that none of them lists."""
    series = sorted(fields.glob("*.pvd"))
    listed = {path for file in series for _, path in states_of(file)}
    for path in series + sorted(set(fields.glob("*.vtu")) - listed):
        draw_file = draw_series if path.suffix == ".pvd" else draw
        output = figures / f"{path.stem}.png"
        yield output, functools.partial(draw_file, path, output, None)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=pathlib.Path, help=".vtu of `dssbench run --output`, or the .pvd that it writes with --frames")
    parser.add_argument("--output", type=pathlib.Path, required=True, help="PNG, SVG or PDF")
    parser.add_argument("--magnification", type=float, help="of displacements (default: the largest becomes 8 %% of the body)")
    arguments = parser.parse_args()
    if not arguments.file.exists():
        sys.exit(f"{arguments.file}: no such file; make it with `dssbench run SCENE --output FILE.vtu` (with --frames: FILE.pvd)")
    if arguments.file.suffix not in (".vtu", ".pvd"):
        sys.exit(f"{arguments.file}: neither a .vtu nor a .pvd")
    draw_file = draw_series if arguments.file.suffix == ".pvd" else draw
    try:
        print(*draw_file(arguments.file, arguments.output, arguments.magnification), sep="\n")
    except Unreadable as fault:
        sys.exit(str(fault))


if __name__ == "__main__":
    main()
