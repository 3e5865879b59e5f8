#!/usr/bin/python3
"""Picture of a body from a .vtu of `dssbench run --output`: its z side, deformed (magnified), coloured by von Mises stress.

Reads the file and nothing else; never runs a solver.
Example: plots/plate_picture.py plate.vtu --output results/figures/plate.png
"""
import argparse
import base64
import pathlib
import sys
import xml.etree.ElementTree

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy  # noqa: E402
from matplotlib.collections import PolyCollection  # noqa: E402

TYPES = {"Float64": "<f8", "Int64": "<i8", "UInt8": "u1"}


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


def draw(path, output, magnification):
    """Draws the +z faces of all elements, back to front."""
    arrays = read_vtu(path)
    rest, moved = arrays["Points", "points"], arrays["PointData", "displacement"]
    stress = arrays["CellData", "von_mises"]
    extent = float(numpy.ptp(rest, axis=0).max())
    largest = float(numpy.abs(moved).max())
    if magnification is None:
        magnification = 0.08 * extent / largest if largest > 0 else 1
    corners = (rest + magnification * moved).reshape(-1, 8, 3)[:, 4:8, :]
    order = numpy.argsort(corners[:, :, 2].mean(axis=1))
    unit, name = max(((u, n) for u, n in ((1e9, "GPa"), (1e6, "MPa"), (1e3, "kPa")) if stress.max() >= u), default=(1, "Pa"))
    figure, axes = plt.subplots(figsize=(7.5, 6), layout="constrained")
    faces = PolyCollection(corners[order, :, :2], array=stress[order] / unit, cmap="cividis", edgecolors="face", linewidths=0.3)
    # A few elements at the load and the clamp carry several times the rest: they must not turn the plate into one colour.
    faces.set_clim(0, float(numpy.percentile(stress, 99)) / unit or 1)
    axes.add_collection(faces)
    axes.autoscale_view()
    axes.set_aspect("equal")
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    axes.set_title(f"{len(stress)} elements; displacements x {magnification:.3g} (largest {largest:.3g} m)", fontsize=10)
    figure.colorbar(faces, ax=axes, label=f"von Mises stress [{name}], largest {stress.max() / unit:.3g}", extend="max")
    output.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(output, dpi=150)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("vtu", type=pathlib.Path, help="file of `dssbench run --output`")
    parser.add_argument("--output", type=pathlib.Path, required=True, help="PNG, SVG or PDF")
    parser.add_argument("--magnification", type=float, help="of displacements (default: the largest becomes 8 %% of the body)")
    arguments = parser.parse_args()
    if not arguments.vtu.exists():
        sys.exit(f"{arguments.vtu}: no such file; make it with `dssbench run SCENE --output FILE.vtu` (with --frames: FILE_0000.vtu ...)")
    if arguments.vtu.suffix != ".vtu":
        sys.exit(f"{arguments.vtu}: not a .vtu; of a .pvd, give one of the files that it lists")
    draw(arguments.vtu, arguments.output, arguments.magnification)
    print(arguments.output)


if __name__ == "__main__":
    main()
