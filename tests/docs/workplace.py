"""A scratch directory for the commands of one page, and what this machine lacks for a command."""
import functools
import json
import os
import re
import shutil
import signal
import subprocess

SOURCE = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../.."))
PROGRAM = os.path.realpath(os.environ["DSSBENCH"])
TIME_LIMIT_S = 120
STUDY = re.compile(r"dssbench experiment (\w+)")
OPTION_LIST = re.compile(r"--(?:variant|hybrid)[ =](\S+)")


def environment(directory):
    """The variables of a command: `dssbench` is on the path, and no `make` above is known."""
    kept = {name: value for name, value in os.environ.items()
            if not name.startswith(("DSSBENCH_", "MAKE", "MFLAGS", "CTEST_"))}
    return {**kept, "PATH": f"{directory}/bin:{os.environ['PATH']}", "SOURCE": SOURCE,
            "BUILD": os.environ["BUILD"],
            "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def furnish(directory, texts, files=()):
    """Puts the program, files as (name, text), and folders that the texts name into a directory."""
    for place in ("bin/dssbench", "build/release/dssbench"):
        os.makedirs(os.path.dirname(f"{directory}/{place}"))
        os.symlink(PROGRAM, f"{directory}/{place}")
    for folder in ("results", "plots", "variants", "experiments", "tests/docs"):
        if any(re.search(rf"(^|[\s=\"'(]){folder}(/|\s|$)", text) for text in texts):
            shutil.copytree(f"{SOURCE}/{folder}", f"{directory}/{folder}")
    for name, text in files:
        with open(f"{directory}/{name}", "w", encoding="utf-8") as file:
            file.write(text)


def finished(text, directory):
    """The exit code and all output of a command line; a command that takes too long is killed."""
    process = subprocess.Popen(["bash", "-c", text], cwd=directory, env=environment(directory),
                               stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True, start_new_session=True)
    try:
        output, _ = process.communicate(timeout=TIME_LIMIT_S)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        output, _ = process.communicate()
        return -1, f"{output}\nnot finished after {TIME_LIMIT_S} s"
    return process.returncode, output


@functools.lru_cache(maxsize=None)
def asked(*arguments):
    """Exit code and standard output of the program."""
    result = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=60)
    return result.returncode, result.stdout


@functools.lru_cache(maxsize=None)
def variants():
    """The status of each variant by its name."""
    rows = json.loads(asked("list", "variants", "--json")[1])
    return {row["variant"]: row["status"] for row in rows}


def with_variants_here(text):
    """The text with AVX2 in place of AVX-512, where only that is usable: their bits are equal."""
    if variants().get("avx512") == "usable" or variants().get("avx2") != "usable":
        return text
    return re.sub(r"\bavx512\b(?!f)", "avx2", text).replace("avx2,avx2", "avx2")


def why_not_here(text):
    """What the command needs and this machine or build lacks, or an empty string."""
    for name in named_variants(text) + ["hybrid"] * ("--hybrid" in text) + variants_of_study(text):
        if variants().get(name, "not built") != "usable":
            return f"variant {name}: {variants().get(name, 'not built')}"
    if ("--ranks" in text or "mpirun" in text) and "simulate" not in text:
        if variants().get("mpi") != "usable" or not shutil.which("mpirun"):
            return "no variant mpi, or no mpirun"
    if "metis" in text and asked("decompose", "l_bracket", "--parts", "2", "--method", "metis")[0]:
        return "a build without METIS"
    if "simulate" in text and asked("simulate", "plate_paper", "--set", "n=10", "--ranks", "2",
                                    "--node-speed", "1e6")[0]:
        return "a build without SimGrid"
    return ""


def named_variants(text):
    """The variants that options of a command name."""
    known = [re.split(r"[@:=]", part)[0] for found in OPTION_LIST.findall(text)
             for part in found.strip('"').split(",")]
    return [name for name in known if name != "auto"]


def variants_of_study(text):
    """The variants that the cells of a shipped study name."""
    found = STUDY.search(text)
    rows = json.loads(asked("list", "experiments", "--json")[1]) if found else []
    path = next((row["path"] for row in rows if row["experiment"] == found[1]), None)
    if path is None:
        return []
    with open(path, encoding="utf-8") as file:
        blocks = json.load(file).get("cells", [])
    return [name for block in blocks for name in block.get("variants", []) if name != "auto"]


def help_of(subcommand):
    """The program's help of a subcommand, with its exit code."""
    return asked(*([subcommand] if subcommand else []), "--help")
