"""Disassembles the modules of variants and checks which instructions they hold.

    disassembly_test.py FOLDER_OF_MODULES [ARCHITECTURE [OBJDUMP]]

variants/isa/NAME/isa.json says what the module NAME.so must hold and lack: regular expressions of
an instruction with its operands, in the row kernels or in the whole module. A module that fails
here would not measure what its name says.
"""
import json
import platform
import re
import subprocess
import sys
from pathlib import Path

ISA = Path(__file__).resolve().parents[2] / "variants/isa"
KERNEL = re.compile(r"RowKernels|StageRow|update_apart")
MANY = 100  # a module has thousands of instructions of the kind that it must hold


def instructions(module, objdump):
    """Yields (function, instruction) for every instruction of a module."""
    text = subprocess.run([objdump, "-d", "--no-show-raw-insn", str(module)], check=True,
                          capture_output=True, text=True).stdout
    function = ""
    for line in text.splitlines():
        header = re.match(r"^[0-9a-f]+ <(.*)>:$", line)
        if header:
            function = header.group(1)
            continue
        parts = line.split("\t", 1)
        if len(parts) == 2:
            yield function, parts[1]


def count(lines, pattern):
    return sum(bool(re.search(pattern, line)) for line in lines)


def failures(variant, promises, module, objdump):
    """Prints a line for each promise, and yields those that are broken."""
    lines = list(instructions(module, objdump))
    kernels = [line for function, line in lines if KERNEL.search(function)]
    found = [("kernels at all", len(kernels), len(kernels) > MANY)]
    for what, pattern in promises["kernels_hold"].items():
        number = count(kernels, pattern)
        found.append((what, number, number > MANY))
    for key, where in (("kernels_lack", kernels), ("module_lacks", [line for _, line in lines])):
        for what, pattern in promises[key].items():
            number = count(where, pattern)
            found.append((f"no {what}", number, number == 0))
    for what, number, holds in found:
        print(f"{variant}: {what}: {number} {'ok' if holds else 'FAILED'}")
        if not holds:
            yield f"{variant}: {what}"


def main():
    folder = Path(sys.argv[1])
    processor = {"x86_64": "x86"}.get(platform.machine(), platform.machine())
    architecture, objdump = (sys.argv[2:] + [processor, "objdump"][len(sys.argv) - 2:])[:2]
    broken, checked = [], 0
    for path in sorted(ISA.glob("*/isa.json")):
        promises = json.loads(path.read_text(encoding="utf-8")).get(architecture)
        module = folder / f"{path.parent.name}.so"
        if promises and module.exists():
            checked += 1
            broken += failures(path.parent.name, promises, module, objdump)
    if not checked:
        sys.exit(f"{folder} has no module to check")
    sys.exit(1 if broken else 0)


main()
