#!/usr/bin/python3
"""Joins the schemas of the kinds of studies into experiments/studies/study.schema.json.

A kind is a schema experiments/studies/KIND/KIND.schema.json with the title "The key KEY of a
study" and a description. The joined schema offers the key, accepts a study that has it, and takes
the scales from `$defs/scale` of the kind. Keys that go with others (cells, simulation,
work_precision) are joined by hand in that file; here they get only their description. The file is
written anew in the layout of json.dumps.

Example: tests/schemas/study_schema.py --check
"""
import argparse
import json
import re
import sys
from pathlib import Path

STUDIES = Path(__file__).resolve().parents[2] / "experiments" / "studies"
JOINED = STUDIES / "study.schema.json"
BY_HAND = ("cells", "simulation", "work_precision")


def kinds(folder):
    """Yields (key, path of its schema in `folder`, description), in the order of the folders."""
    for path in sorted(folder.glob("*/*.schema.json")):
        schema = json.loads(path.read_text())
        title = re.fullmatch(r"The key (\w+) of a study", schema.get("title", ""))
        if not title:
            sys.exit(f'{path}: the title is not "The key KEY of a study"')
        if not schema.get("description"):
            sys.exit(f"{path}: has no description")
        yield title[1], str(path.relative_to(folder)), schema["description"]


def joined(schema, found):
    """The schema with the parts of all kinds in `found`. Parts of former kinds are left out."""
    found = list(found)
    paths = {key: path for key, path, _ in found}
    former = [key for key, part in schema["properties"].items()
              if re.fullmatch(r"(\w+)/\1\.schema\.json", part.get("$ref", ""))
              and key not in BY_HAND]
    simple = [key for key in paths if key not in BY_HAND]
    dropped = set(former + simple)
    parts = {key: part for key, part in schema["properties"].items() if key not in dropped}
    parts |= {key: {"$ref": path, "description": text}
              for key, path, text in found if key not in BY_HAND or key in parts}
    of_key = [{"if": {"required": [key]}, "then": {"properties": {"scales": {
        "additionalProperties": {"$ref": f"{paths[key]}#/$defs/scale"}}}}} for key in simple]
    kept = [rule for rule in schema["allOf"]
            if not set(rule["if"].get("required", [])) & dropped]
    alternatives = [each for each in schema["anyOf"] if not set(each["required"]) & dropped]
    return schema | {"properties": parts,
                     "anyOf": alternatives + [{"required": [key]} for key in simple],
                     "allOf": kept + of_key}


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Writes " + str(JOINED))
    parser.add_argument("--check", action="store_true",
                        help="write nothing; exit with 1 if the file is not current")
    present = JOINED.read_text()
    text = json.dumps(joined(json.loads(present), kinds(STUDIES)), indent=2) + "\n"
    if not parser.parse_args().check:
        JOINED.write_text(text)
    elif text != present:
        sys.exit(f"{JOINED}: is not what the kinds give; run make pages")
