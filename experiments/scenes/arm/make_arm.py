#!/usr/bin/python3
"""Writes arm.stl, a suspension arm, and road.csv, what wheel and car do to it.

The arm has two bushings towards the car, whose axes lie along x (forward), and an eye for the ball
joint of the wheel, whose axis is vertical. Two legs and a brace join them. Lengths are in mm. The
surface is a set of closed parts that overlap, as assemblies of CAD programs are.
Example: experiments/scenes/arm/make_arm.py experiments/scenes/arm
"""
import argparse
import math
import pathlib
import struct

BUSHING = {"outer": 24, "bore": 14, "length": 50, "x": 130}
BALL = {"outer": 32, "bore": 16, "length": 48, "x": 20, "y": 340}
LEG = {"inner": 20, "outer": 24, "height": 24}  # radii of its rounded ends
BRACE = {"radius": 13, "height": 24, "y": 130}
SIDES = 96


def circle(centre, radius, sides=SIDES):
    """Points around a centre, anticlockwise."""
    return [(centre[0] + radius * math.cos(2 * math.pi * n / sides),
             centre[1] + radius * math.sin(2 * math.pi * n / sides)) for n in range(sides)]


def hull(points):
    """The convex hull, anticlockwise (Andrew's monotone chain)."""
    def half(ordered):
        chain = []
        for p in ordered:
            while len(chain) > 1:
                (ax, ay), (bx, by) = chain[-2:]
                if (bx - ax) * (p[1] - ay) - (by - ay) * (p[0] - ax) > 1e-9:
                    break
                chain.pop()
            chain.append(p)
        return chain[:-1]
    ordered = sorted(set(points))
    return half(ordered) + half(ordered[::-1])


def prism(outline, low, high):
    """A convex outline in x and y, from z = low to high."""
    bottom, top = [(*p, low) for p in outline], [(*p, high) for p in outline]
    count = len(outline)
    facets = []
    for n in range(1, count - 1):
        facets += [(bottom[0], bottom[n + 1], bottom[n]), (top[0], top[n], top[n + 1])]
    for n in range(count):
        after = (n + 1) % count
        facets += [(bottom[n], bottom[after], top[after]), (bottom[n], top[after], top[n])]
    return facets


def ring(centre, outer, bore, low, high):
    """A hollow cylinder along z."""
    facets = []
    corners = [[(*p, z) for p in circle(centre, radius)]
               for radius in (outer, bore) for z in (low, high)]
    outer_low, outer_high, bore_low, bore_high = corners
    for n in range(SIDES):
        m = (n + 1) % SIDES
        for a, b, c, d in ((outer_low[n], outer_low[m], outer_high[m], outer_high[n]),
                           (bore_low[m], bore_low[n], bore_high[n], bore_high[m]),
                           (outer_high[n], outer_high[m], bore_high[m], bore_high[n]),
                           (outer_low[m], outer_low[n], bore_low[n], bore_low[m])):
            facets += [(a, b, c), (a, c, d)]
    return facets


def along_x(facets):
    """Turns z to x, x to y and y to z."""
    return [tuple((z, x, y) for x, y, z in facet) for facet in facets]


def leg(x):
    """From a bushing at x to the ball joint; it ends short of both bores."""
    start = (x, BUSHING["bore"] + 2 + LEG["inner"])
    way = (start[0] - BALL["x"], start[1] - BALL["y"])
    part = (BALL["bore"] + 2 + LEG["outer"]) / math.hypot(*way)
    end = (BALL["x"] + part * way[0], BALL["y"] + part * way[1])
    outline = hull(circle(start, LEG["inner"]) + circle(end, LEG["outer"]))
    return prism(outline, -LEG["height"] / 2, LEG["height"] / 2)


def arm():
    """All facets."""
    facets = []
    half = BUSHING["length"] / 2
    for x in (-BUSHING["x"], BUSHING["x"]):
        facets += along_x(ring((0, 0), BUSHING["outer"], BUSHING["bore"], x - half, x + half))
        facets += leg(x)
    facets += ring((BALL["x"], BALL["y"]), BALL["outer"], BALL["bore"], -BALL["length"] / 2,
                   BALL["length"] / 2)
    ends = [(-85, BRACE["y"]), (95, BRACE["y"])]
    outline = hull(circle(ends[0], BRACE["radius"]) + circle(ends[1], BRACE["radius"]))
    return facets + prism(outline, -BRACE["height"] / 2, BRACE["height"] / 2)


def write_stl(path, facets):
    """Binary STL; readers take the normals from the order of the corners."""
    with open(path, "wb") as file:
        file.write(b"suspension arm, mm".ljust(80, b" ") + struct.pack("<I", len(facets)))
        for facet in facets:
            file.write(struct.pack("<12fH", 0, 0, 0, *(c for corner in facet for c in corner), 0))


def road(t):
    """What acts at a time [s]: forces on the ball joint, and the motion of the car's body.

    The wheel runs over a bump while the car brakes; the body follows a little later.
    """
    def bump(begin, length):
        return math.sin(math.pi * (t - begin) / length) ** 2 if 0 < t - begin < length else 0.0
    brake = 1 - math.exp(-t / 0.004)
    return (t, -1800 * brake, 600 * bump(0.002, 0.006), 4500 * bump(0.001, 0.005)
            - 1500 * bump(0.0065, 0.006), 25 * bump(0.003, 0.012),
            0.004 * bump(0.003, 0.02) * brake)


def write_road(path):
    """A row each 0.25 ms."""
    lines = ["t [s],brake [1],side [1],bump [1],heave [m/s^2],roll [rad]"]
    lines += [",".join(f"{value + 0.0:.6g}" for value in road(2.5e-4 * n)) for n in range(97)]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def main():
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    folder = parser.parse_args().folder
    write_stl(folder / "arm.stl", arm())
    write_road(folder / "road.csv")


if __name__ == "__main__":
    main()
