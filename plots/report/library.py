"""plotly.min.js from a virtual environment with the wheel of requirements.txt."""
import pathlib
import subprocess
import sys

REQUIREMENTS = pathlib.Path(__file__).with_name("requirements.txt")
LIBRARY = "lib/python3*/site-packages/plotly/package_data/plotly.min.js"
PIP_OPTIONS = ["--quiet", "--disable-pip-version-check", "--retries", "1", "--timeout", "10",
               "--no-deps", "--no-compile", "--require-hashes"]


def installed(environment):
    """The path of plotly.min.js, or None if `environment` lacks this version."""
    found = sorted(pathlib.Path(environment).glob(LIBRARY))
    stamp = pathlib.Path(environment) / REQUIREMENTS.name
    is_current = stamp.exists() and stamp.read_bytes() == REQUIREMENTS.read_bytes()
    return found[0] if found and is_current else None


def install(environment):
    """Makes a new virtual environment with Plotly; checks its hash.

    @returns (path of plotly.min.js, ""), or (None, why it cannot be installed)
    """
    is_new = not environment.is_dir() or not any(environment.iterdir())
    if not is_new and not (environment / "pyvenv.cfg").exists():
        return None, (f"{environment} is neither empty nor a virtual environment: "
                      "nothing there is touched")
    for command in ([sys.executable, "-m", "venv", "--clear", str(environment)],
                    [str(environment / "bin" / "pip"), "install", *PIP_OPTIONS,
                     "--requirement", str(REQUIREMENTS)]):
        try:
            result = subprocess.run(command, capture_output=True, text=True, timeout=120)
        except (OSError, subprocess.TimeoutExpired) as fault:
            return None, f"{command[0]}: {fault}"
        if result.returncode:
            lines = [line for line in (result.stderr or result.stdout).splitlines()
                     if line.strip()]
            return None, lines[-1] if lines else f"{command[0]} ended with {result.returncode}"
    (environment / REQUIREMENTS.name).write_bytes(REQUIREMENTS.read_bytes())
    return installed(environment), ""
