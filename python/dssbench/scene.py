"""Scenes from Python: dicts and arrays in place of files."""
import contextlib
import copy
import json
import os
import pathlib
import tempfile
from typing import Any, Iterator, Mapping, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core

Changes = Mapping[str, Any] | None
AnyScene = Union[str, "os.PathLike[str]", dict[str, Any], "Scene"]


def text_of(value: Any) -> str:
    """A value as --set takes it: the shortest number that reads back the same."""
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    return repr(float(value)) if isinstance(value, (float, np.floating)) else str(value)


def pairs_of_set(changes: Changes) -> list[tuple[str, str]]:
    """{"n": 50} as keys and values of --set."""
    return [(key, text_of(value)) for key, value in (changes or {}).items()]


def words_of_set(changes: Changes) -> list[str]:
    """The same as words of a command: --set n=50."""
    return [word for key, value in pairs_of_set(changes) for word in ("--set", f"{key}={value}")]


@contextlib.contextmanager
def file_of(scene: AnyScene) -> Iterator[str]:
    """Name or path of a scene. A dict or Scene becomes a file while the context lasts."""
    if isinstance(scene, dict):
        scene = Scene(scene)
    if not isinstance(scene, Scene):
        yield os.fspath(scene)
        return
    with tempfile.TemporaryDirectory(prefix="dssbench-") as folder:
        yield str(scene.save(pathlib.Path(folder) / "scene.json"))


def plain(value: Any) -> Any:
    """Arrays and numbers of NumPy as JSON has them."""
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    if isinstance(value, np.ndarray):
        return value.tolist()
    return value.item() if isinstance(value, np.generic) else value


class Scene:
    """A scene as a dict with the keys of solver/scene/README.md, and arrays of voxels.

    A body may have the geometry {"voxels": ARRAY}: ARRAY[x, y, z] is 0 for a hole, else the number
    of the material (1 to 255). Names of other files are absolute, or relative to where `save` puts
    the scene.

        bar = dssbench.Scene.of_voxels(np.ones((20, 4, 4)), element=0.01,
                                       constants={"law": "solid", "E": 1e7, "nu": 0.3, "rho": 1000})
        bar["clamps"] = [{"select": {"face": "-x"}}]
        bar["loads"] = [{"select": {"face": "+x"}, "force": [0, 0, -1], "share": "total"}]
        bar.set_run(duration=0.01)
    """

    def __init__(self, keys: Mapping[str, Any]):
        self.keys = copy.deepcopy(dict(keys))
        self.keys.setdefault("scene", "scene")
        self.keys.setdefault("title", self.keys["scene"])

    @classmethod
    def of_voxels(cls, voxels: ArrayLike, element: float | list[float],
                  constants: Mapping[str, Any], name: str = "body", **keys: Any) -> "Scene":
        """One body of an array.

        element    edge of an element [m], or three edges
        constants  of the body: {"law": "solid", "E": 1e7, "nu": 0.3, "rho": 1000}
        keys       further keys of the scene
        """
        body = {"name": name, "geometry": {"voxels": np.asarray(voxels)}, "element": element,
                "constants": constants}
        return cls({"scene": name, "bodies": [body], **keys})

    def __getitem__(self, key: str) -> Any:
        return self.keys[key]

    def __setitem__(self, key: str, value: Any) -> None:
        self.keys[key] = value

    def set_run(self, duration: float, integrator: str = "rk4", share: float = 0.5) -> None:
        """Steps of equal length for a duration [s]: a share of the largest stable step."""
        before = self.keys.get("run", {})
        trial = Scene({**self.keys, "run": {**before, "dt": 1e-9, "steps": 1}})
        limit = stable_step(trial, integrator=integrator)
        if not limit > 0:
            raise _core.InputError(f"set_run: {integrator} has no stable step for this scene")
        steps = max(1, int(np.ceil(duration / (share * limit))))
        self.keys["run"] = {**before, "dt": duration / steps, "steps": steps,
                            "integrator": integrator}

    def save(self, path: str | os.PathLike[str]) -> pathlib.Path:
        """Writes the scene, and the voxels of its bodies as .npy beside it. Returns the path."""
        path = pathlib.Path(path)
        keys = copy.deepcopy(self.keys)
        for number, body in enumerate(keys.get("bodies", [])):
            voxels = body.get("geometry", {}).get("voxels")
            if isinstance(voxels, np.ndarray):
                name = f"{path.stem}_{number}.npy"
                np.save(path.parent / name, whole_numbers(voxels))
                body["geometry"]["voxels"] = {"file": name}
        path.write_text(json.dumps(plain(keys), indent=2) + "\n")
        return path


def whole_numbers(voxels: NDArray[Any]) -> NDArray[np.uint8]:
    """Voxels as bytes. Raises InputError for other numbers."""
    if voxels.ndim != 3:
        raise _core.InputError(f"voxels: the array has {voxels.ndim} axes; give x, y and z")
    numbers = voxels.astype(np.uint8)
    if not np.array_equal(numbers, voxels):
        raise _core.InputError("voxels: a number is not 0 to 255; give 0 for a hole, else the "
                               "number of the material")
    return numbers


def stable_step(scene: AnyScene, *, set: Changes = None, integrator: str = "rk4") -> float:
    """Safe step [s] of a method about the state of rest. The true limit may be up to 1.8 times as
    long."""
    with file_of(scene) as path:
        return _core.stable_step(path, pairs_of_set(set), integrator)
