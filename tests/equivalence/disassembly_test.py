"""Disassembles the variant modules and checks which instructions their row kernels hold.

avx512  fused multiply-adds on zmm
avx2    fused multiply-adds on ymm, and no zmm anywhere
scalar  neither FMA nor packed arithmetic in the kernels

A module that fails here would not measure what its name says.
"""
import re
import subprocess
import sys
from pathlib import Path

KERNEL = re.compile(r"RowKernels|StageRow|update_apart")
FMA = re.compile(r"^vf(n?m)(add|sub)\d+p[ds]$")
PACKED = re.compile(r"^v?(add|sub|mul|div)p[ds]$|^vf.*p[ds]$")


def instructions(module):
    """Yields (function, mnemonic, operands) for every instruction of a module."""
    text = subprocess.run(
        ["objdump", "-d", "--no-show-raw-insn", str(module)], check=True, capture_output=True,
        text=True,
    ).stdout
    function = ""
    for line in text.splitlines():
        header = re.match(r"^[0-9a-f]+ <(.*)>:$", line)
        if header:
            function = header.group(1)
            continue
        parts = line.split("\t")
        if len(parts) == 2:
            words = parts[1].split(None, 1)
            yield function, words[0], words[1] if len(words) > 1 else ""


def counts(module):
    result = {"kernel": 0, "fma_zmm": 0, "fma_ymm": 0, "fma": 0, "packed": 0, "zmm": 0}
    for function, mnemonic, operands in instructions(module):
        result["zmm"] += "%zmm" in operands
        if not KERNEL.search(function):
            continue
        result["kernel"] += 1
        is_fma = mnemonic.startswith(("vfmadd", "vfmsub", "vfnmadd", "vfnmsub"))
        result["fma"] += is_fma
        result["fma_zmm"] += is_fma and "%zmm" in operands
        result["fma_ymm"] += is_fma and "%ymm" in operands
        result["packed"] += bool(PACKED.match(mnemonic))
    return result


def main():
    folder = Path(sys.argv[1])
    failures = []
    for variant, checks in {
            "avx512": [("fma_zmm", lambda n: n > 100, "fused multiply-adds on zmm")],
            "avx2": [("fma_ymm", lambda n: n > 100, "fused multiply-adds on ymm"),
                     ("zmm", lambda n: n == 0, "no zmm register")],
            "scalar": [("kernel", lambda n: n > 100, "kernels at all"),
                       ("fma", lambda n: n == 0, "no FMA"),
                       ("packed", lambda n: n == 0, "no packed arithmetic")],
    }.items():
        found = counts(folder / f"{variant}.so")
        for key, holds, meaning in checks:
            verdict = "ok" if holds(found[key]) else "FAILED"
            print(f"{variant}: {meaning}: {found[key]} {verdict}")
            if verdict != "ok":
                failures.append(f"{variant}: {meaning}")
    sys.exit(1 if failures else 0)


main()
