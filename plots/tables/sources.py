"""Which sources a record depends on, and whether they have changed since.

A record names digests of the sources that made it (experiments/measure/circumstances.cpp). The
digests of the present tree are computed in the same way (experiments/base/build_info.cmake).
"""
import functools
import hashlib
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
CORE = ("kernels", "solver", "variants", "experiments/base", "experiments/run",
        "experiments/measure")
NOT_CORE = ROOT / "experiments" / "run" / "verify"  # what it finds is in no record
KINDS = (".cpp", ".hpp", ".h", ".cl", ".in", ".cmake")
WORDS = {"core": "what measures (kernels, solver, variants, runner)",
         "json": "the JSON of its study"}


@functools.cache
def digest(*folders):
    """Digest of all sources in folders of the tree, by their paths and contents."""
    files = [path for folder in folders for path in (ROOT / folder).rglob("*")
             if path.is_file() and (path.suffix in KINDS or path.name == "CMakeLists.txt")
             and NOT_CORE not in path.parents]
    names = sorted(path.relative_to(ROOT).as_posix() for path in files)
    lines = [f"{name} {hashlib.sha256((ROOT / name).read_bytes()).hexdigest()}\n"
             for name in names]
    return hashlib.sha256("".join(lines).encode()).hexdigest()[:16]


@functools.cache
def fnv1a(path):
    """FNV-1a, 64 bits, of a file."""
    value = 0xcbf29ce484222325
    for byte in path.read_bytes():
        value = (value ^ byte) * 0x100000001b3 % 2**64
    return f"{value:016x}"


def present(name, study):
    """The present digest of a source that a record names; empty if it is not in this tree."""
    if name == "core":
        return digest(*CORE)
    if name != "json":
        return digest(f"experiments/{name}") if (ROOT / "experiments" / name).is_dir() else ""
    path = next((ROOT / "experiments" / "studies").glob(f"*/{study}.json"), None)
    return fnv1a(path) if path else ""


def changed(record_sources, study):
    """The sources of a record, in words, that differ from those of this tree."""
    return [WORDS.get(name, "the code of its kind of study")
            for name, then in record_sources.items() if present(name, study) not in ("", then)]
