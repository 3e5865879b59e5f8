"""The program for aarch64, run under qemu-user, computes the bits of the program for this machine.

    aarch64_test.py NATIVE_BUILD AARCH64_BUILD

It compares digests of final states: scalar and neon there with avx2 and avx512 here. Then it runs
`dssbench verify` there, and checks which instructions its modules hold.
"""
import concurrent.futures
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
EMULATOR = ("qemu-aarch64", "-L", "/usr/aarch64-linux-gnu")
HERE, THERE = ("avx2", "avx512"), ("scalar", "neon")
PLATE = ("plate_paper", "--set", "n=10")
METHODS = ("rk4", "velocity_verlet", "smoothed_verlet", "midpoint", "symplectic_euler", "dopri5",
           "verner8", "rkc2")
STEPS = "100"
SMALL = {"plate_paper": {"set": {"n": 6}, "steps": 20}, "two_bodies": {"steps": 20}}


def cases():
    """Yields the arguments of `dssbench run` for each case."""
    models = [(PLATE, model) for model in ("membrane", "planar", "linear", "small")]
    models += [(("two_bodies",), model) for model in ("linear", "small")]
    models += [(("two_elements",), "axial"), (("plate_bending", "--set", "n=6"), "bending")]
    for precision in ("f64", "f32"):
        for scene, model in models:
            for method in ("rk4", "velocity_verlet"):
                yield *scene, "--model", model, "--precision", precision, "--integrator", method
        for scene in (PLATE, ("two_bodies",)):
            for method in METHODS:
                yield *scene, "--model", "spatial", "--precision", precision, "--integrator", method
        yield *PLATE, "--model", "spatial", "--precision", precision, "--threads", "3"
    yield *PLATE, "--model", "spatial", "--precision", "f32c"


def digest(program, variant, case):
    """The digest of the final state, or what the program said instead."""
    result = subprocess.run(
        [*program, "run", *case, "--variant", variant, "--steps", STEPS, "--check-tail", "0",
         "--json", "-"], capture_output=True, text=True, check=False)
    if result.returncode != 0:
        return f"exit code {result.returncode}: {result.stderr.strip()[:300]}"
    record = json.loads(result.stdout)
    return record["state_digest"] if record["has_fma"] else "computed without FMA"


def usable_variants(program):
    listed = subprocess.run([*program, "list", "variants", "--json"], capture_output=True,
                            text=True, check=True)
    return [item["variant"] for item in json.loads(listed.stdout) if item["status"] == "usable"]


def differing_digests(here, there):
    """The number of cases whose digests differ; says which."""
    natives = [name for name in HERE if name in usable_variants(here)]
    missing = set(THERE) - set(usable_variants(there))
    if not natives or missing:
        sys.exit(f"nothing to compare: here {natives or 'neither avx2 nor avx512'}, "
                 f"missing under {EMULATOR[0]}: {sorted(missing) or 'nothing'}")
    runs = [(here, name) for name in natives] + [(there, name) for name in THERE]
    all_cases, wrong = list(cases()), 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for case, digests in zip(all_cases, pool.map(
                lambda case: [digest(*run, case) for run in runs], all_cases)):
            first = digests[0]
            if len(set(digests)) > 1 or len(first) != 16:
                wrong += 1
                print("FAILED", " ".join(case), dict(zip([*natives, *THERE], digests)))
    print(f"{len(all_cases)} cases: {', '.join(natives)} here, {', '.join(THERE)} under "
          f"{EMULATOR[0]}: {wrong or 'none'} of them with other bits")
    return wrong


def verify(there):
    """Verifies even smaller versions of two scenes; returns the exit code."""
    with tempfile.TemporaryDirectory() as folder:
        paths = []
        for name, small in SMALL.items():
            scene = json.loads((ROOT / f"experiments/scenes/{name}.json").read_text("utf-8"))
            scene["verify"] = small
            paths.append(Path(folder, f"{name}.json"))
            paths[-1].write_text(json.dumps(scene), encoding="utf-8")
        return subprocess.call(
            [*there, "verify", "--quiet", *paths, "--variant", ",".join(THERE)])


def main():
    native, cross = Path(sys.argv[1]), Path(sys.argv[2])
    here, there = [str(native / "dssbench")], [*EMULATOR, str(cross / "dssbench")]
    steps = {
        "digests": lambda: differing_digests(here, there),
        "verify": lambda: verify(there),
        "instructions": lambda: subprocess.call(
            ["/usr/bin/python3", ROOT / "tests/equivalence/disassembly_test.py",
             cross / "variants", "aarch64", "aarch64-linux-gnu-objdump"]),
    }
    failed = []
    for name, run in steps.items():
        start = time.monotonic()
        if run() != 0:
            failed.append(name)
        print(f"== {name}: {time.monotonic() - start:.0f} s", flush=True)
    sys.exit(f"FAILED: {', '.join(failed)}" if failed else 0)


main()
