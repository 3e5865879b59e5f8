#!/usr/bin/python3
"""Writes the figures that pages quote from the tables of results (quotes.py).

With --check, writes nothing: exit code 1 if a page quotes another figure than its table has.
Example: plots/fill_pages.py --check
"""
import argparse
import pathlib
import subprocess
import sys

from quotes import filled, read_quotes
from tables.results import ROOT, Results


def pages_of(root):
    """All pages of the tree."""
    names = subprocess.run(["git", "-C", root, "ls-files", "--cached", "--others",
                            "--exclude-standard", "*.md"],
                           capture_output=True, text=True, check=True).stdout.split()
    return [root / name for name in names]


def main():
    """Fills or checks all pages, or those that are named."""
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--results", type=pathlib.Path, default=ROOT / "results")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("pages", nargs="*", type=pathlib.Path)
    arguments = parser.parse_args()
    results, quotes, faults = Results(arguments.results), read_quotes(), []
    for page in arguments.pages or pages_of(ROOT):
        old = page.read_text(encoding="utf-8")
        new, unknown = filled(old, results, quotes)
        faults += [f"{page}: {fault}" for fault in unknown]
        if new == old:
            continue
        if not arguments.check:
            beside = page.with_suffix(".md.new")
            beside.write_text(new, encoding="utf-8")
            beside.replace(page)
            continue
        for number, (was, now) in enumerate(zip(old.split("\n"), new.split("\n")), 1):
            if was != now:
                faults.append(f"{page}:{number}: {was.strip()}; the tables say: {now.strip()}")
    for fault in faults:
        print(fault, file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
