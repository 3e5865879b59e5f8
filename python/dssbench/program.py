"""The program `dssbench`, which times runs in a process of its own and judges them."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
from typing import Any

from . import _core
from .results import Results
from .scene import AnyScene, Changes, file_of, plain, words_of_set

EXIT_CHECK_FAILED, EXIT_BAD_INPUT, EXIT_UNSTABLE = 1, 2, 3


class CheckFailed(RuntimeError):
    """A run ended, but a check of it failed. `record` is what it reported."""

    def __init__(self, what: str, record: dict[str, Any] | None = None):
        super().__init__(what)
        self.record = record


def program() -> str:
    """Path of the program: of this wheel, else of the build tree."""
    prefix = os.environ.get("DSSBENCH_PREFIX")
    return str(pathlib.Path(prefix) / "bin" / "dssbench") if prefix else _core.built_program


def main() -> None:
    """The command `dssbench` of a wheel."""
    os.execv(program(), [program(), *sys.argv[1:]])


def words_of(options: dict[str, Any]) -> list[str]:
    """Options as words: rtol=1e-6 is --rtol 1e-6, force=True is --force, a list is given once for
    each item."""
    words = []
    for key, value in options.items():
        option = "--" + key.replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            words.append(option)
            continue
        for item in value if isinstance(value, (list, tuple)) else [value]:
            words += [option, os.fspath(item) if isinstance(item, os.PathLike) else str(item)]
    return words


def failure(done: subprocess.CompletedProcess[str],
            record: dict[str, Any] | None = None) -> Exception:
    """The exception of a program that did not end with 0."""
    said = (done.stderr.strip() or done.stdout.strip() or f"exit code {done.returncode}")
    what = said.splitlines()[-1].removeprefix("dssbench: ")
    if done.returncode == EXIT_CHECK_FAILED:
        return CheckFailed(what, record)
    kinds = {EXIT_BAD_INPUT: _core.InputError, EXIT_UNSTABLE: _core.UnstableError}
    return kinds.get(done.returncode, RuntimeError)(what)


def run(scene: AnyScene, *, set: Changes = None, **options: Any) -> dict[str, Any]:
    """Runs a scene as `dssbench run` does: timed, and with its energy balance judged.

    scene    name, path, dict or Scene
    set      parameters and scalars of the scene that change: {"n": 50}
    options  those of the command (`dssbench help run`): variant="avx2", threads=2, steps=100,
             state="end.csv", ranks=2, ...
    returns  the record as a dict; `dssbench list columns` explains its keys
    raises   InputError, UnstableError, CheckFailed
    """
    if options.get("json") == "-":
        raise _core.InputError("json: run returns the record; give a file, or leave it out")
    with tempfile.TemporaryDirectory(prefix="dssbench-") as folder, file_of(scene) as path:
        file = pathlib.Path(options.pop("json", None) or pathlib.Path(folder) / "record.json")
        words = [program(), "run", path, *words_of_set(set), *words_of(options),
                 "--json", str(file)]
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        record: dict[str, Any] = {}
        if done.returncode in (0, EXIT_CHECK_FAILED) and file.exists():
            record = json.loads(file.read_text())
    if done.returncode != 0:
        raise failure(done, record)
    return record


def experiment(study: str | os.PathLike[str] | dict[str, Any], out: str | os.PathLike[str],
               **options: Any) -> Results:
    """Measures a study as `dssbench experiment` does.

    study    name, path or dict
    out      folder of its results
    returns  Results of that folder
    raises   InputError, UnstableError, CheckFailed
    """
    with tempfile.TemporaryDirectory(prefix="dssbench-") as folder:
        if isinstance(study, dict):
            path = pathlib.Path(folder) / "study.json"
            path.write_text(json.dumps(plain(study)))
            study = path
        words = [program(), "experiment", os.fspath(study), "--out", os.fspath(out),
                 *words_of(options)]
        done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise failure(done)
    return Results(out)
