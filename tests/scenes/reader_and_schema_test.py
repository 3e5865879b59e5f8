"""The scene reader and scene.schema.json agree.

usage: reader_and_schema_test.py READ_SCENE SCHEMA SCENES BAD_SCENES

Three checks:
* Every shipped scene passes both.
* The reader refuses every case of bad_scenes.json, in one line with the words that the case names.
  The schema refuses it, too, where a schema can.
* Each place of a valid scene is spoiled: a key renamed, a type changed, a key removed. The reader
  accepts nothing that the schema refuses. Neither accepts an unknown key or type.
"""
import copy
import json
import pathlib
import subprocess
import sys
import tempfile

try:
    import jsonschema
except ImportError:
    print("skipped: python3-jsonschema is not installed")
    sys.exit(77)


def has_free_keys(pointer):
    """Whether a scene chooses the keys of this object. An override is any scalar."""
    return pointer == "/parameters" or pointer.endswith("/set")


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
    """Yields (what was done, scene, whether both must refuse it)."""
    for pointer, value in places(base):
        parent, _, key = pointer.rpartition("/")
        is_member = not key.isdigit()
        if is_member and not has_free_keys(parent):
            yield f"{pointer} renamed", changed(base, pointer, rename=key + "_x"), True
        yield f"{pointer} null", changed(base, pointer, None), True
        if isinstance(value, (dict, list)):
            yield f"{pointer} made a text", changed(base, pointer, "text"), True
        else:
            yield f"{pointer} made an object", changed(base, pointer, {"x_x": 1}), True
            if not isinstance(value, bool) and not parent.endswith("/set"):
                yield f"{pointer} made a truth value", changed(base, pointer, True), True
        yield f"{pointer} removed", changed(base, pointer, remove=True), False


def read_all(program, folder, scenes):
    """The reader's answer to each scene, one line each."""
    paths = []
    for number, scene in enumerate(scenes):
        paths.append(str(folder / f"scene_{number}.json"))
        pathlib.Path(paths[-1]).write_text(json.dumps(scene), encoding="utf-8")
    run = subprocess.run([program, *paths], capture_output=True, text=True, check=False)
    lines = run.stdout.splitlines()
    if run.returncode != 0 or len(lines) != len(scenes):
        sys.exit(
            f"the reader ended with {run.returncode} after {len(lines)} lines "
            f"for {len(scenes)} scenes: {run.stderr}"
        )
    return lines


def main(program, schema_path, scenes_path, bad_path):
    schema = json.loads(pathlib.Path(schema_path).read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    bad = json.loads(pathlib.Path(bad_path).read_text(encoding="utf-8"))
    shipped = {path.name: json.loads(path.read_text(encoding="utf-8"))
               for path in sorted(pathlib.Path(scenes_path).glob("*.json"))}
    failures = []

    def expect(condition, message):
        if not condition:
            failures.append(message)

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        good = {"base": bad["base"], **shipped}
        expect(len(shipped) >= 9, f"only {len(shipped)} shipped scenes found")
        for (title, scene), line in zip(good.items(), read_all(program, folder, list(
                good.values()))):
            expect(line.startswith("ok "), f"{title}: {line}")
            expect(validator.is_valid(scene), f"{title}: the schema refuses it")

        scenes = []
        for case in bad["cases"]:
            scene = bad["base"]
            for pointer, value in case.get("with", {}).items():
                scene = changed(scene, pointer, value)
            scenes.append(changed(scene, case["at"], case.get("put"), case.get("remove", False)))
        for case, scene, line in zip(bad["cases"], scenes, read_all(program, folder, scenes)):
            expect(line.startswith("refused ") and case["says"] in line, f"{case}: {line}")
            expect(
                validator.is_valid(scene) == (case["schema"] == "accepts"),
                f"{case}: the schema does not agree")

        count = 0
        for title, base in good.items():
            variants = list(spoiled(base))
            count += len(variants)
            lines = read_all(program, folder, [scene for _, scene, _ in variants])
            for (done, scene, must_refuse), line in zip(variants, lines):
                is_read, is_valid = line.startswith("ok "), validator.is_valid(scene)
                expect(is_valid or not is_read,
                       f"{title} with {done}: read, but the schema refuses it")
                expect(not (must_refuse and is_read), f"{title} with {done}: read")
                expect(not (must_refuse and is_valid), f"{title} with {done}: valid by the schema")
    for failure in failures:
        print("FAILED", failure)
    print(
        f"{len(good)} good scenes, {len(bad['cases'])} bad cases, {count} spoiled scenes, "
        f"{len(failures)} failures"
    )
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
