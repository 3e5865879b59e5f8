#!/usr/bin/python3
"""Draws a decomposition: each part has a colour, and elements sent to other parts are darker.

A body of several z layers is drawn as at most 4 of its layers. The command reads a file of
`dssbench decompose --output`. No solver runs.
Example: plots/decomposition_picture.py plate.json -o results/figures/plate_parts.png
"""
import argparse
import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy  # noqa: E402
from render.check import Unreadable  # noqa: E402
from render.pictures import drawn_now, save  # noqa: E402

# The colours of Okabe and Ito can be told apart with any colour vision. More parts than colours
# repeat them; neighbours get different ones where that is possible.
COLOURS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#F0E442", "#999999")
NEEDED = ("scene", "method", "elements", "depth", "bodies", "row_places", "parts")
MOST_ELEMENTS = 20_000_000
MOST_LAYERS = 4
MOST_LABELS = 64


def read(path):
    """The content of the file. Ends the command if the file lacks what a picture needs."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, json.JSONDecodeError) as error:
        sys.exit(f"{path}: {error}; make it with "
                 "`dssbench decompose SCENE --parts P --output FILE`")
    known = content if isinstance(content, dict) else {}
    lacking = [key for key in NEEDED if key not in known]
    if lacking or not all("boundary" in part for part in content["parts"]):
        sys.exit(f"{path}: lacks {', '.join(lacking) or 'the boundary of a part'}; "
                 "give a file of `dssbench decompose --output`")
    if content["elements"] > MOST_ELEMENTS:
        sys.exit(f"{path}: {content['elements']} elements are too many for a picture; "
                 "decompose a smaller scene (--set n=1000)")
    return content


def elements_of(content):
    """(row, x, part, is it sent) as arrays over all elements, in the order of their numbers."""
    segments = numpy.array([[*segment, part["part"]] for part in content["parts"]
                            for segment in part["segments"]])
    segments = segments[numpy.lexsort((segments[:, 1], segments[:, 0]))]
    lengths = segments[:, 2] - segments[:, 1]
    first = numpy.repeat(numpy.cumsum(lengths) - lengths, lengths)
    row, begin, part = (numpy.repeat(segments[:, column], lengths) for column in (0, 1, 3))
    is_sent = numpy.zeros(len(row), dtype=bool)
    for one in content["parts"]:
        for face in one["boundary"]:
            for start, count in face["send"]:
                is_sent[start:start + count] = True
    return row, begin + numpy.arange(len(row)) - first, part, is_sent


def colours_of(content):
    """A colour for each part: the least used one that no earlier neighbour has."""
    used = [0] * len(COLOURS)
    chosen = []
    for number, part in enumerate(content["parts"]):
        taken = {chosen[face["part"]] for face in part["boundary"] if face["part"] < number}
        everything = range(len(COLOURS))
        free = [colour for colour in everything if colour not in taken] or everything
        chosen.append(min(free, key=lambda colour: (used[colour], colour)))
        used[chosen[-1]] += 1
    return numpy.array([matplotlib.colors.to_rgb(COLOURS[colour]) for colour in chosen])


def layers_of(bodies, place):
    """Heights [m] of at most MOST_LAYERS layers of elements, spread over all layers."""
    heights = set()
    for number, body in enumerate(bodies):
        bottom, edge = body["origin"][2], body["edge"][2]
        layers = numpy.unique(place[place[:, 0] == number, 2])
        heights.update(round(float(bottom + edge * (layer + 0.5)), 9) for layer in layers)
    heights = sorted(heights)
    picked = numpy.unique(numpy.linspace(0, len(heights) - 1, MOST_LAYERS).round().astype(int))
    return [heights[k] for k in picked]


def draw_layer(axes, content, elements, height, colours):
    """Draws the elements of all bodies at one height."""
    row, x, part, is_sent = elements
    place = numpy.array(content["row_places"])
    for number, body in enumerate(content["bodies"]):
        (hx, hy, hz), (x0, y0, z0) = body["edge"], body["origin"]
        # A height on the face between two layers belongs to the upper one, whatever the rounding.
        layer = int(numpy.floor((height - z0) / hz + 1e-6))
        here = (place[row, 0] == number) & (place[row, 2] == layer)
        if not here.any():
            continue
        columns, lines, parts = x[here], place[row[here], 1], part[here]
        image = numpy.zeros((lines.max() + 1, columns.max() + 1, 4))
        shade = numpy.where(is_sent[here], 0.6, 1.0)[:, None]
        image[lines, columns] = numpy.hstack((colours[parts] * shade, numpy.ones_like(shade)))
        extent = (x0, x0 + hx * image.shape[1], y0, y0 + hy * image.shape[0])
        axes.imshow(image, origin="lower", extent=extent, interpolation="nearest")
        if len(colours) <= MOST_LABELS:
            label_parts(axes, x0 + hx * (columns + 0.5), y0 + hy * (lines + 0.5), parts)


def label_parts(axes, x, y, parts):
    """Writes the number of each part at the centre of its elements; x and y are their centres."""
    box = {"boxstyle": "round,pad=0.15", "facecolor": "white", "edgecolor": "none", "alpha": 0.75}
    for part in numpy.unique(parts):
        mine = parts == part
        axes.text(x[mine].mean(), y[mine].mean(), str(part), ha="center", va="center", fontsize=9,
                  bbox=box)


def limits(content, elements):
    """Lowest and highest x and y of all elements [m]."""
    row, x, _, _ = elements
    place = numpy.array(content["row_places"])[row]
    edge = numpy.array([body["edge"] for body in content["bodies"]])[place[:, 0]]
    low = numpy.array([body["origin"] for body in content["bodies"]])[place[:, 0]]
    low = low[:, :2] + edge[:, :2] * numpy.column_stack((x, place[:, 1]))
    return low.min(axis=0), (low + edge[:, :2]).max(axis=0)


def draw(content, output):
    """Draws one panel for each layer."""
    elements, colours = elements_of(content), colours_of(content)
    heights = layers_of(content["bodies"], numpy.array(content["row_places"]))
    low, high = limits(content, elements)
    has_one = len(heights) == 1
    size = (7.5, 6) if has_one else (3.5 * len(heights), 4.5)
    figure, panels = plt.subplots(1, len(heights), figsize=size, layout="constrained",
                                  squeeze=False)
    for axes, height in zip(panels[0], heights):
        draw_layer(axes, content, elements, height, colours)
        axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal",
                 xlabel="x [m]", ylabel="y [m]")
        if not has_one:
            axes.set_title(f"z = {height:.3g} m", fontsize=10)
    figure.suptitle(f"{content['scene']}: {content['elements']} elements in {len(colours)} parts "
                    f"by {content['method']}; darker: sent to other parts, "
                    f"halo of {content['depth']}", fontsize=10)
    save(figure, output, drawn_now(), dpi=150)
    plt.close(figure)


def main():
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=pathlib.Path, help="file of `dssbench decompose --output`")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True,
                        help="PNG, SVG or PDF")
    arguments = parser.parse_args()
    try:
        draw(read(arguments.file), arguments.output)
    except Unreadable as fault:
        sys.exit(str(fault))
    print(arguments.output)


if __name__ == "__main__":
    main()
