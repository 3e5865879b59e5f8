"""dssbench: run scenes, step them, and read results.

    import dssbench
    record = dssbench.run("plate_paper", set={"n": 50}, steps=500, variant="avx2")
    simulation = dssbench.Simulation("plate_paper", set={"n": 50})
    simulation.advance(100)
    simulation.displacement.max()
    dssbench.load("results").table("table1")

Units are SI. Errors of the input are InputError, a ValueError; a run that becomes unstable is
UnstableError, an ArithmeticError.
"""
import os
import pathlib

_PREFIX = pathlib.Path(__file__).parent / "prefix"
if _PREFIX.is_dir():  # of a wheel; else the files are those of the build tree
    os.environ.setdefault("DSSBENCH_PREFIX", str(_PREFIX))

from . import _core  # noqa: E402  it reads the variable
from ._core import InputError, UnstableError, field_names  # noqa: E402
from .program import CheckFailed, experiment, run  # noqa: E402
from .results import Results, load, read_history, read_state  # noqa: E402
from .scene import Scene, stable_step  # noqa: E402
from .simulation import Simulation  # noqa: E402

commit = _core.commit


def variants() -> list[dict[str, str]]:
    """Execution targets: a list of {"name", "isa", "unusable"}. `unusable` is empty if the variant
    runs here, else the reason."""
    return _core.variants()


def scenes() -> list[dict[str, object]]:
    """Shipped scenes: a list of {"name", "title", "path", "parameters"}."""
    return _core.scenes()


__all__ = ["CheckFailed", "InputError", "Results", "Scene", "Simulation", "UnstableError", "commit",
           "experiment", "field_names", "load", "read_history", "read_state", "run", "scenes",
           "stable_step", "variants"]
