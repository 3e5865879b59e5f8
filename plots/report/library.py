"""plotly.min.js, as the wheel in requirements.txt carries it, from a virtual environment."""
import pathlib
import subprocess
import sys

REQUIREMENTS = pathlib.Path(__file__).with_name("requirements.txt")


def installed(environment):
    """Its file, if this version is installed there."""
    found = sorted(pathlib.Path(environment).glob("lib/python3*/site-packages/plotly/package_data/plotly.min.js"))
    stamp = pathlib.Path(environment) / REQUIREMENTS.name
    return found[0] if found and stamp.exists() and stamp.read_text(encoding="utf-8") == REQUIREMENTS.read_text(encoding="utf-8") else None


def install(environment):
    """Installs it, by hash, in place of what the environment has. @returns its file, and else a line that says why not"""
    if environment.is_dir() and any(environment.iterdir()) and not (environment / "pyvenv.cfg").exists():
        return None, f"{environment} is neither empty nor a virtual environment: nothing there is touched"
    commands = [[sys.executable, "-m", "venv", "--clear", str(environment)],
                [str(environment / "bin" / "pip"), "install", "--quiet", "--disable-pip-version-check", "--retries", "1", "--timeout", "10", "--no-deps", "--no-compile", "--require-hashes",
                 "--requirement", str(REQUIREMENTS)]]
    for command in commands:
        try:
            result = subprocess.run(command, capture_output=True, text=True, timeout=120)
        except (OSError, subprocess.TimeoutExpired) as fault:
            return None, f"{command[0]}: {fault}"
        if result.returncode:
            words = [line for line in (result.stderr or result.stdout).splitlines() if line.strip()]
            return None, words[-1] if words else f"{command[0]} ended with {result.returncode}"
    (environment / REQUIREMENTS.name).write_text(REQUIREMENTS.read_text(encoding="utf-8"), encoding="utf-8")
    return installed(environment), ""
