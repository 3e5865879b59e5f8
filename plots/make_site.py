#!/usr/bin/python3
"""Builds all pages of the tree as a static site that opens from disk: SITE/index.html.

Example: plots/make_site.py build/site
"""
import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from fill_pages import pages_of
from tables.results import ROOT

LINK = re.compile(r"\]\(([^)#\s]+)[^)\s]*\)")


def linked_files(page):
    """Files of the tree that a page links to, relative to the root."""
    for target in LINK.findall((ROOT / page).read_text(encoding="utf-8")):
        path = (ROOT / page.parent / target).resolve()
        if path.is_file() and path.is_relative_to(ROOT):
            yield path.relative_to(ROOT)


def number(page):
    """The number in the name of a page of docs/."""
    return int(page.name.partition("_")[0])


def title(page):
    """How the list of pages names a page: its folder, or its path."""
    return str(page.parent if page.name == "README.md" else page.with_suffix(""))


def settings(all_pages, source, site):
    """The settings of MkDocs. Pages keep their places in the tree, so links stay as they are."""
    numbered = sorted((page for page in all_pages
                       if page.parent.name == "docs" and page.name[0].isdigit()), key=number)
    rest = sorted(page for page in all_pages if page not in numbered and str(page) != "README.md")
    return {"site_name": "dssbench", "docs_dir": str(source), "site_dir": str(site),
            "use_directory_urls": False, "theme": {"name": "mkdocs", "highlightjs": False},
            "plugins": [], "nav": ["README.md", {"Guide": [*map(str, numbered)]},
                                   {"Reference": [{title(page): str(page)} for page in rest]}]}


def build(site):
    """Copies pages with what they link to, and lets MkDocs build them. Returns its exit code."""
    all_pages = [page.relative_to(ROOT) for page in pages_of(ROOT)]
    with tempfile.TemporaryDirectory(prefix="dssbench-site-") as folder:
        source = pathlib.Path(folder) / "pages"
        for path in {*all_pages, *(file for page in all_pages for file in linked_files(page))}:
            (source / path).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / path, source / path)
        config = pathlib.Path(folder) / "mkdocs.yml"
        config.write_text(json.dumps(settings(all_pages, source, site.resolve())),
                          encoding="utf-8")  # JSON is YAML
        return subprocess.run(["mkdocs", "build", "--quiet", "--config-file", config]).returncode


def main():
    """Builds the site."""
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("site", type=pathlib.Path, help="folder that is made anew")
    arguments = parser.parse_args()
    if shutil.which("mkdocs") is None:
        sys.exit("make_site: mkdocs is not installed; `make site` installs it")
    sys.exit(build(arguments.site))


if __name__ == "__main__":
    main()
