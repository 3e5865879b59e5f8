"""The static site: it has every page, and each link of a page leads to a file of it."""
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest
import urllib.parse

import pages
import workplace

TARGET = re.compile(r'(?:href|src)="([^"#]+)[^"]*"')
NOT_COMMITTED = "report.html"  # REPORT.md says that it is there only where it was built


@unittest.skipUnless(shutil.which("mkdocs"), "there is no mkdocs; `make site` installs it")
class Site(unittest.TestCase):
    def made_from(self, site, page):
        """The HTML of a page. MkDocs makes index.html from the README of a folder."""
        folder = site / pathlib.Path(page).parent
        stem = pathlib.Path(page).stem
        html = folder / ("index.html" if stem == "README" else f"{stem}.html")
        self.assertTrue(html.is_file(), page)
        return html

    def test_every_page_is_there_and_no_link_is_broken(self):
        with tempfile.TemporaryDirectory(prefix="dssbench-site-") as folder:
            site = pathlib.Path(folder)
            script = pathlib.Path(workplace.SOURCE) / "plots" / "make_site.py"
            subprocess.run([script, site], check=True)
            for page in pages.tracked_pages(workplace.SOURCE):
                html = self.made_from(site, page)
                for target in TARGET.findall(html.read_text(encoding="utf-8")):
                    if urllib.parse.urlparse(target).scheme or target.endswith(NOT_COMMITTED):
                        continue
                    with self.subTest(page=page, target=target):
                        self.assertTrue((html.parent / urllib.parse.unquote(target)).exists())


if __name__ == "__main__":
    unittest.main()
