#!/usr/bin/python3
"""Writes disc.stl, a disc with a bore, and holed_plate.stl, a square plate with a hole.

The bore of the disc has the radius 0.1 m, its rim 0.2 m. The hole of the plate has the radius 1 m,
the plate half an edge of 4 m. Both are 0.1 m thick. Circles are regular polygons of 128 sides with
the area of the circle. Example: make_surfaces.py experiments/scenes/verification
"""
import argparse
import math
import pathlib
import struct

SIDES = 128


def circle(radius):
    """Corners of the polygon with the area of a circle, anticlockwise. None is on an axis, so that
    the polygon is not wider than the circle along x and y."""
    angle = 2 * math.pi / SIDES
    grown = radius * math.sqrt(angle / math.sin(angle))
    return [(grown * math.cos((n + 0.5) * angle), grown * math.sin((n + 0.5) * angle))
            for n in range(SIDES)]


def square(half):
    """Points on the edge of a square, as many as corners of a circle."""
    points = []
    for n in range(SIDES):
        x, y = math.cos(2 * math.pi * n / SIDES), math.sin(2 * math.pi * n / SIDES)
        scale = half / max(abs(x), abs(y))
        points.append((x * scale, y * scale))
    return points


def hollow(outer, inner, thickness):
    """Facets of a plate between two outlines with as many corners. Its middle is at z = 0."""
    low, high = -thickness / 2, thickness / 2
    facets = []

    def quad(a, b, c, d):
        facets.extend([(a, b, c), (a, c, d)])
    for n in range(SIDES):
        after = (n + 1) % SIDES
        (o, p), (i, j) = (outer[n], outer[after]), (inner[n], inner[after])
        quad((*o, low), (*p, low), (*p, high), (*o, high))
        quad((*i, low), (*i, high), (*j, high), (*j, low))
        quad((*o, high), (*p, high), (*j, high), (*i, high))
        quad((*o, low), (*i, low), (*j, low), (*p, low))
    return facets


def write(path, title, facets):
    """Binary STL; readers find normals from the corners."""
    with open(path, "wb") as file:
        file.write(struct.pack("<80sI", title.encode().ljust(80), len(facets)))
        for facet in facets:
            numbers = [0.0, 0.0, 0.0, *(x for corner in facet for x in corner)]
            file.write(struct.pack("<12fH", *numbers, 0))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=pathlib.Path)
    folder = parser.parse_args().folder
    write(folder / "disc.stl", "disc with a bore, m", hollow(circle(0.2), circle(0.1), 0.1))
    write(folder / "holed_plate.stl", "plate with a hole, m", hollow(square(4), circle(1), 0.1))


if __name__ == "__main__":
    main()
