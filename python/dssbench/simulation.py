"""A run that Python advances."""
import os
import pathlib
import tempfile
from typing import Any, Callable

import numpy as np
from numpy.typing import NDArray

from . import _core
from .scene import AnyScene, Changes, file_of, pairs_of_set

VELOCITY, TURN, SPIN = slice(3, 6), slice(6, 10), slice(10, 13)


class Simulation(_core.Simulation):
    """One scene on one variant, in this process: neither timed nor judged (`run` does that).

        simulation = dssbench.Simulation("plate_paper", set={"n": 50}, variant="avx2")
        simulation.advance(1000, every=100, callback=lambda s: print(s.time, s.energy))

    scene    name, path, dict or Scene
    set      parameters and scalars of the scene that change: {"n": 50}
    options  variant, threads, device, hybrid, tile, model, precision, integrator, rotation, dt [s],
             force, as for `dssbench run`. The scene has the defaults. The default model is
             `spatial` where the scene says `auto`.

    state is an array of shape (elements, 13): u [m], v [m/s], quaternion (q0 - 1, q1, q2, q3),
    w [rad/s], in the order of dssbench.field_names. It is the simulation's own memory, read-only:
    nothing is copied. The next look at the state after advance() overwrites it, so copy what you
    want to keep. Assign an array to set the state; the method then starts anew.
    """

    def __init__(self, scene: AnyScene, set: Changes = None, **options: Any):
        with file_of(scene) as path:
            super().__init__(path, pairs_of_set(set), **options)

    def advance(self, steps: int | None = None, every: int | None = None,
                callback: Callable[["Simulation"], Any] | None = None) -> None:
        """Advances by so many steps (default: those of the scene).

        callback  called with this object after each `every` steps; advance() ends if it returns
                  False
        raises    UnstableError if a step fails; KeyboardInterrupt leaves a good state
        """
        left = self.steps if steps is None else steps
        if callback is None:
            super().advance(left)
            return
        if every is None or every < 1:
            raise _core.InputError("advance: give `every` of 1 step or more with a callback")
        while left > 0:
            super().advance(min(every, left))
            left -= every
            if callback(self) is False:
                return

    @property
    def displacement(self) -> NDArray[np.float64]:
        """(elements, 3) [m], a view of the state."""
        return self.state[:, :3]

    @property
    def velocity(self) -> NDArray[np.float64]:
        """(elements, 3) [m/s], a view of the state."""
        return self.state[:, VELOCITY]

    @property
    def angular_velocity(self) -> NDArray[np.float64]:
        """(elements, 3) [rad/s], a view of the state."""
        return self.state[:, SPIN]

    @property
    def quaternion(self) -> NDArray[np.float64]:
        """(elements, 4), q0 first: a copy."""
        return self.state[:, TURN] + (1, 0, 0, 0)

    def picture(self, path: str | os.PathLike[str] | None = None) -> "Picture | None":
        """The stress on the deformed body as SVG, which a notebook shows; or into a file."""
        if path is not None:
            self.write_picture(os.fspath(path))
            return None
        with tempfile.TemporaryDirectory(prefix="dssbench-") as folder:
            file = pathlib.Path(folder) / "picture.svg"
            self.write_picture(str(file))
            return Picture(file.read_text())

    def __repr__(self) -> str:
        return (f"<Simulation {self.name}: {self.elements} elements, step {self.step}, "
                f"t = {self.time:.6g} s ({self.model}, {self.precision}, {self.integrator}, "
                f"{self.variant})>")


class Picture(str):
    """Text of an SVG file, which notebooks draw."""

    def _repr_svg_(self) -> str:
        return str(self)
