"""Installs a wheel into a new environment, imports it, runs a scene and draws a figure."""
import os
import subprocess
import sys
import tempfile
import time
import venv

CODE = """
import matplotlib
matplotlib.use("Agg")
import dssbench
from dssbench import plots
simulation = dssbench.Simulation("plate_paper", set={"n": 20})
simulation.advance(100)
record = dssbench.run("plate_paper", set={"n": 20}, steps=100, model="spatial",
                      variant=simulation.variant)
assert record["state_digest"] == simulation.digest, record
plots.body(simulation).figure.savefig("plate.png")
"""


def main():
    wheel = os.path.realpath(sys.argv[1])
    # without the variables and paths of this tree
    kept = {name: value for name, value in os.environ.items()
            if not name.startswith(("DSSBENCH", "PYTHON", "CMAKE"))}
    with tempfile.TemporaryDirectory(prefix="dssbench-wheel-") as folder:
        venv.create(f"{folder}/venv", with_pip=True)

        def must(*words):
            # no compiler is on the path
            subprocess.run([f"{folder}/venv/bin/{words[0]}", *words[1:]], check=True, cwd=folder,
                           env={**kept, "PATH": f"{folder}/venv/bin"})

        start = time.monotonic()
        must("pip", "install", "--quiet", f"{wheel}[plots]")
        must("python", "-c", CODE)
        assert os.path.getsize(f"{folder}/plate.png") > 1000
        must("dssbench", "run", "two_elements", "--variant", "scalar")
        print(f"installed, imported, run and drawn in {time.monotonic() - start:.0f} s")


if __name__ == "__main__":
    main()
