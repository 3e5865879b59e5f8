"""A reader and its schema agree: for scenes and for studies.

usage: reader_and_schema_test.py READER SCHEMA FOLDER BAD_CASES

Four checks:
* The schema describes every key.
* Every shipped file in FOLDER passes both, and names the schema.
* The reader refuses every case of BAD_CASES, in one line with the words that the case names. The
  schema refuses it, too, where a schema can.
* Each place of a valid file is spoiled: a key renamed, a type changed, a key removed. The reader
  accepts nothing that the schema refuses. Neither accepts an unknown key or type.
"""
import copy
import json
import pathlib
import re
import subprocess
import sys
import tempfile

try:
    import jsonschema
except ImportError:
    print("skipped: python3-jsonschema is not installed")
    sys.exit(77)


# Objects whose keys the file chooses: parameters, fields, overrides, scales, steps by overrides.
FREE_KEYS = re.compile(
    r"/(parameters|fields|set|scales|grids/\d+|weak(/\d+)?|steps_by_set|steps_for)$")
# Their values may be any scalar.
OVERRIDES = re.compile(r"/(set|grids/\d+|weak/\d+)/")
# A build may lack this variant, which shipped studies name.
MAY_BE_ABSENT = 'unknown variant "scalar-native"'


def schema_files(path):
    """A schema file and all files that it refers to, by their paths."""
    files = {}
    waiting = [path.resolve()]
    while waiting:
        file = waiting.pop()
        if file in files:
            continue
        files[file] = json.loads(file.read_text(encoding="utf-8"))
        for pointer, value in places(files[file]):
            if pointer.endswith("/$ref") and not value.startswith("#"):
                waiting.append((file.parent / value.partition("#")[0]).resolve())
    return files


def undescribed_keys(schema):
    """Keys of the objects that allow no others, without a description."""
    for pointer, value in [("", schema), *places(schema)]:
        if not isinstance(value, dict) or not isinstance(value.get("properties"), dict):
            continue
        is_strict = not value.get("additionalProperties", True) or not value.get(
            "unevaluatedProperties", True)
        for key, member in value["properties"].items():
            if is_strict and member is not False and not member.get("description"):
                yield f"{pointer}/properties/{key}"


def changed(scene, pointer, value=None, remove=False, rename=None):
    scene = copy.deepcopy(scene)
    *parents, last = pointer.split("/")[1:]
    place = scene
    for part in parents:
        place = place[int(part)] if isinstance(place, list) else place[part]
    if isinstance(place, list):
        last = int(last)
    if remove:
        del place[last]
    elif rename:
        place[rename] = place.pop(last)
    else:
        place[last] = value
    return scene


def places(value, pointer=""):
    """Yields pointer and value of everything inside, parents first."""
    items = (value.items() if isinstance(value, dict) else
             enumerate(value) if isinstance(value, list) else ())
    for key, item in items:
        yield f"{pointer}/{key}", item
        yield from places(item, f"{pointer}/{key}")


def spoiled(base):
    """Yields (what was done, file, whether both must refuse it)."""
    for pointer, value in places(base):
        parent, _, key = pointer.rpartition("/")
        is_free = OVERRIDES.search(pointer) is not None
        if not key.isdigit() and not FREE_KEYS.search(parent):
            yield f"{pointer} renamed", changed(base, pointer, rename=key + "_x"), True
        yield f"{pointer} null", changed(base, pointer, None), True
        if isinstance(value, dict):
            yield f"{pointer} made a text", changed(base, pointer, "text"), True
        elif isinstance(value, list):
            yield f"{pointer} made an object", changed(base, pointer, {"x_x": 1}), True
            yield f"{pointer} made a text", changed(base, pointer, "text"), False
        else:
            yield f"{pointer} made an object", changed(base, pointer, {"x_x": 1}), True
            if not isinstance(value, bool) and not is_free:
                yield f"{pointer} made a truth value", changed(base, pointer, True), True
                yield f"{pointer} made negative", changed(base, pointer, -7), False
        yield f"{pointer} removed", changed(base, pointer, remove=True), False


class Check:
    """A reader, its schema, and what was found wrong."""

    def __init__(self, reader, schema_path, folder):
        self.reader = reader
        self.folder = pathlib.Path(folder)
        self.failures = []
        schema_path = pathlib.Path(schema_path).resolve()
        files = schema_files(schema_path)
        for path, schema in files.items():
            jsonschema.Draft202012Validator.check_schema(schema)
            for key in undescribed_keys(schema):
                self.expect(False, f"{path.name}: {key} has no description")
        by_address = {path.as_uri(): schema for path, schema in files.items()}
        resolver = jsonschema.RefResolver(schema_path.as_uri(), files[schema_path], by_address)
        self.is_valid = jsonschema.Draft202012Validator(files[schema_path],
                                                        resolver=resolver).is_valid
        self.schema_path = schema_path

    def expect(self, condition, message):
        if not condition:
            self.failures.append(message)

    def answers_to(self, paths):
        """The reader's answer to each file: "ok", or "refused" and why."""
        run = subprocess.run([self.reader, *map(str, paths)], capture_output=True, text=True,
                             check=False)
        lines = [line[3:] for line in run.stdout.splitlines() if line.startswith("== ")]
        if run.returncode != 0 or len(lines) != len(paths):
            sys.exit(f"the reader ended with {run.returncode} after {len(lines)} of {len(paths)} "
                     f"files: {run.stderr}")
        return lines

    def answers(self, contents):
        paths = []
        for number, content in enumerate(contents):
            paths.append(self.folder / f"file_{number}.json")
            paths[-1].write_text(json.dumps(content), encoding="utf-8")
        return self.answers_to(paths)

    def check_shipped(self, paths):
        for path, answer in zip(paths, self.answers_to(paths)):
            self.expect(answer == "ok" or MAY_BE_ABSENT in answer, f"{path}: {answer}")
            content = json.loads(path.read_text(encoding="utf-8"))
            self.expect(self.is_valid(content), f"{path}: the schema refuses it")
            named = (path.parent / content.get("$schema", "")).resolve()
            self.expect(named == self.schema_path, f"{path}: its $schema is {named}")

    def check_cases(self, bases, cases):
        contents = []
        for case in cases:
            content = bases[case.get("of", "base")]
            for pointer, value in case.get("with", {}).items():
                content = changed(content, pointer, value)
            contents.append(
                changed(content, case["at"], case.get("put"), case.get("remove", False)))
        for case, content, answer in zip(cases, contents, self.answers(contents)):
            self.expect(answer.startswith("refused ") and case["says"] in answer,
                        f"{case}: {answer}")
            self.expect(
                self.is_valid(content) == (case["schema"] == "accepts"),
                f"{case}: the schema does not agree")

    def check_spoiled(self, title, base):
        """Returns how many files were tried."""
        self.expect(self.answers([base]) == ["ok"], f"{title}: {self.answers([base])}")
        self.expect(self.is_valid(base), f"{title}: the schema refuses it")
        variants = list(spoiled(base))
        answers = self.answers([content for _, content, _ in variants])
        for (done, content, must_refuse), answer in zip(variants, answers):
            is_valid = self.is_valid(content)
            self.expect(is_valid or answer != "ok",
                        f"{title} with {done}: read, but the schema refuses it")
            self.expect(not (must_refuse and answer == "ok"), f"{title} with {done}: read")
            self.expect(not (must_refuse and is_valid), f"{title} with {done}: valid by the schema")
        return len(variants)


def main(reader, schema_path, shipped_folder, bad_path):
    bad = json.loads(pathlib.Path(bad_path).read_text(encoding="utf-8"))
    shipped = [path for path in sorted(pathlib.Path(shipped_folder).rglob("*.json"))
               if not path.name.endswith(".schema.json")]
    with tempfile.TemporaryDirectory() as name:
        check = Check(reader, schema_path, name)
        check.expect(len(shipped) >= 17, f"only {len(shipped)} shipped files found")
        check.check_shipped(shipped)
        check.check_cases(bad["bases"], bad["cases"])
        good = dict(bad["bases"])
        if bad.get("spoils_shipped"):
            for path in pathlib.Path(shipped_folder).glob("*.json"):
                good[path.name] = json.loads(path.read_text(encoding="utf-8"))
        count = sum(check.check_spoiled(title, base) for title, base in good.items())
    for failure in check.failures:
        print("FAILED", failure)
    print(f"{len(shipped)} shipped files, {len(bad['cases'])} bad cases, {count} spoiled files, "
          f"{len(check.failures)} failures")
    return 1 if check.failures else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
