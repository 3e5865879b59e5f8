#!/usr/bin/python3
"""Packs the committed tree as a ZIP file for an archive such as Zenodo, with RO-Crate metadata.

The metadata say which program measured which records, when, from which study. They follow
RO-Crate 1.1 (w3id.org/ro/crate/1.1) and the profile Process Run Crate 0.5. With the same git and
zlib, one commit gives the same bytes. Example: plots/make_archive.py build/dssbench.zip
"""
import argparse
import datetime
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import zipfile

from tables.age import Record
from tables.results import ROOT, study_of

METADATA = "ro-crate-metadata.json"
CRATE, PROFILE = "https://w3id.org/ro/crate/1.1", "https://w3id.org/ro/wfrun/process/0.5"
AUTHORS = "#authors"
KINDS = {"": "text/plain", ".csv": "text/csv", ".json": "application/json",
         ".md": "text/markdown", ".cff": "application/yaml"}
PAGES = ("README.md", "ARTIFACT.md", "DESIGN.md", "HACKING.md", "CITATION.cff", "LICENSE")
FOLDERS = {"kernels": "the equations of motion", "solver": "the solver core and the oracle",
           "variants": "the solver for each kind of machine", "experiments": "scenes and studies",
           "plots": "what draws the figures", "results": "records as measured, tables, figures",
           "tests": "tests", "docs": "the guide"}


def git(*words):
    """What git prints. It writes local times into a ZIP file, so the time zone is set."""
    return subprocess.run(["git", "-C", ROOT, *words], capture_output=True, text=True, check=True,
                          env={**os.environ, "TZ": "UTC"}).stdout.strip()


def reference(*names):
    """References to entities; one of them is no list."""
    found = [{"@id": name} for name in names]
    return found[0] if len(found) == 1 else found


def file_entity(name):
    """A file of the tree."""
    return {"@id": name, "@type": "File", "encodingFormat": KINDS[pathlib.Path(name).suffix]}


def citation():
    """title, version and license of CITATION.cff."""
    text = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    return dict(re.findall(r'^(title|version|license): "?([^"\n]*)"?$', text, re.M))


def action_of(path, files):
    """A study as measured: an action with its program, its input and its results; their files.

    A record knows when its repetitions ended, so the action has no time of its start.
    """
    record, folder = Record(path), path.parent.parent
    study, place = study_of(record.name), folder.relative_to(ROOT)
    tables = sorted(table for table in (folder / "tables").glob("*.csv")
                    if study_of(table.stem) == study)
    made = [name for name in (str(one.relative_to(ROOT))
                              for one in (path, path.with_suffix(".csv"), *tables))
            if name in files]
    inputs = [name for name in files
              if re.fullmatch(rf"experiments/studies/\w+/{study}\.json", name)]
    context = record.context
    return {"@id": f"#{place}/{record.name}", "@type": "CreateAction",
            "name": f"the study {record.name} in {place}", "endTime": record.last.isoformat(),
            "instrument": reference(f"#dssbench-{record.commit}{'-changed' * record.is_dirty}"),
            "agent": reference(AUTHORS), "object": reference(*inputs), "result": reference(*made),
            "description": f"measured on {context['num_cpus']} cores of {context['cpu_model']}, "
                           f"{context['compiler']}"}, [*inputs, *made]


def is_study(path):
    """False for files such as devices.json, which no study wrote."""
    return "context" in json.loads(path.read_text(encoding="utf-8"))


def crate_of(files, commit, date):
    """The metadata of a commit. files: all names of the tree"""
    about, parts, actions = citation(), [name for name in PAGES if name in files], []
    for path in sorted((ROOT / "results").rglob("raw/*.json")):
        if str(path.relative_to(ROOT)) in files and is_study(path):
            action, named = action_of(path, files)
            actions.append(action)
            parts += named
    parts = list(dict.fromkeys(parts))
    programs = list(dict.fromkeys(action["instrument"]["@id"] for action in actions))
    folders = [f"{name}/" for name in FOLDERS]
    graph = [
        {"@id": METADATA, "@type": "CreativeWork", "conformsTo": reference(CRATE),
         "about": reference("./")},
        {"@id": "./", "@type": "Dataset", "name": about["title"], "version": about["version"],
         "description": f"Program, studies and results at commit {commit}.",
         "datePublished": date, "license": reference(f"https://spdx.org/licenses/"
                                                     f"{about['license']}"),
         "conformsTo": reference(PROFILE), "author": reference(AUTHORS),
         "publisher": reference(AUTHORS), "hasPart": reference(*parts, *folders),
         "mentions": reference(*(action["@id"] for action in actions))},
        {"@id": f"https://spdx.org/licenses/{about['license']}", "@type": "CreativeWork",
         "name": about["license"]},
        {"@id": PROFILE, "@type": "CreativeWork", "name": "Process Run Crate", "version": "0.5"},
        {"@id": AUTHORS, "@type": "Organization", "name": "The dssbench authors"}]
    graph += [{"@id": f"{name}/", "@type": "Dataset", "name": name, "description": words}
              for name, words in FOLDERS.items()]
    graph += [{"@id": name, "@type": "SoftwareApplication", "name": "dssbench",
               "softwareVersion": name.partition("-")[2]} for name in programs]
    return {"@context": f"{CRATE}/context",
            "@graph": [*graph, *map(file_entity, parts), *actions]}


def pack(output):
    """Writes the archive. Returns the digest of its bytes."""
    commit = git("rev-parse", "HEAD")
    date = datetime.datetime.fromisoformat(git("log", "-1", "--format=%cI"))
    files = git("ls-tree", "-r", "--name-only", "HEAD").splitlines()
    text = json.dumps(crate_of(files, commit, date.date().isoformat()), indent=1)
    beside = output.parent / f"{output.name}.new"
    try:
        git("archive", "--format=zip", f"--output={beside.resolve()}", "HEAD")
        with zipfile.ZipFile(beside, "a") as archive:
            entry = zipfile.ZipInfo(METADATA, date.timetuple()[:6])  # not the time of this run
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            archive.writestr(entry, text + "\n")
        digest = hashlib.sha256(beside.read_bytes()).hexdigest()
        beside.replace(output)
    finally:
        beside.unlink(missing_ok=True)
    return digest


def main():
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("output", type=pathlib.Path, help="FILE.zip")
    output = parser.parse_args().output
    try:
        if git("status", "--porcelain", "--untracked-files=no"):
            sys.exit("make_archive: the tree has changes that are not committed; commit them, so "
                     "that the archive is of one commit")
        digest = pack(output)
    except OSError as fault:
        sys.exit(f"make_archive: {fault.filename or output}: {fault.strerror or fault}")
    except subprocess.CalledProcessError as fault:
        sys.exit(f"make_archive: {fault.stderr.strip().splitlines()[-1]}")
    except (LookupError, ValueError, TypeError, AttributeError) as fault:
        sys.exit(f"make_archive: a record in results cannot be read: {fault!r}")
    print(f"{output}: {output.stat().st_size / 2**20:.1f} MiB, sha256 {digest}")


if __name__ == "__main__":
    main()
