"""Tests the report in headless Chromium: charts, filters, themes, a phone, and no network."""
import json
import os
import pathlib
import shutil
import tempfile
import unittest

import report
import sample

try:
    import matplotlib  # noqa: F401
    import pandas  # noqa: F401
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.ui import Select, WebDriverWait
except ImportError as missing:
    report.skip_all(f"this python has no {missing.name}")
DRIVER = shutil.which("chromedriver")
if not DRIVER or not shutil.which("chromium"):
    report.skip_all("there is no chromium with chromium-driver")

# Reads what a chart shows: its size, its traces, and its marks that have a size.
DRAWN = """
const chart = arguments[0], box = chart.getBoundingClientRect();
const all = (selector) => [...chart.querySelectorAll(selector)];
const hasSize = (mark) => {
  const box = mark.getBoundingClientRect();
  return box.width + box.height > 0;
};
const look = (mark) =>
  ["transform", "d", "href"].map((name) => mark.getAttribute(name) || "").join("");
return {
  look: all(".scatterlayer path, .barlayer path, .heatmaplayer image").map(look).join(),
  main: all("svg.main-svg").length,
  traces: Number(chart.dataset.traces),
  marks: all(".scatterlayer .trace path, .barlayer .point path, .heatmaplayer image")
    .filter(hasSize).length,
  width: box.width,
  height: box.height,
};
"""
SECTIONS = ["paper-1", "paper-2", "paper-3", "figure-9", "speedups-1",
            "speedups-2", "speedups-3", "sizes-3", "chain", "chain-block", "chain-bending",
            "work-precision-time", "work-precision-evaluations", "pareto", "implicit-time",
            "exponential-time", "scaling-1",
            "scaling-2", "cluster", "cluster-nodes", "mixed-nodes", "balance", "stability",
            "energy", "ladder", "ladder-errors", "atlas", "advice", "error-budget", "continuum",
            "verification", "statics"]
FOCUS = """
const at = document.activeElement, section = at.closest("section");
return [at.tagName, at.id || at.name || at.className, section ? section.id : ""];
"""
BACKGROUND = "getComputedStyle(document.body).backgroundColor"
SAMPLE_SECTIONS = ["roofline", "attribution", "chain", "paper-1", "speedups-1", "atlas",
                   "speedups-1-host"]
BROWSER_OPTIONS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                   "--window-size=1280,900", "--no-first-run", "--disable-background-networking",
                   "--disable-component-update"]


class BrowserTest(unittest.TestCase):
    """Pages of the sample and of the committed results in a browser."""

    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory(prefix="dssbench-report-")
        cls.addClassCleanup(holder.cleanup)
        directory = pathlib.Path(holder.name)
        sample.write_sample(directory / "sample")
        report.copy_committed(directory / "committed")
        cls.urls = {}
        for name in ("sample", "committed"):
            result = report.make_report(directory / name)
            if result.returncode:
                raise AssertionError(result.stderr)
            if "Plotly cannot be installed" in result.stderr:
                report.skip_all(result.stderr.strip())
            cls.urls[name] = (directory / name / "report.html").as_uri()
        options = Options()
        for argument in (*BROWSER_OPTIONS, f"--user-data-dir={directory / 'profile'}"):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        os.environ["no_proxy"] = "localhost,127.0.0.1"  # the driver is on this machine
        cls.browser = webdriver.Chrome(service=Service(DRIVER), options=options)
        cls.addClassCleanup(cls.browser.quit)
        cls.windows = {}

    def open(self, name, width=1280):
        """Shows a page at a width; its window stays open for further tests."""
        if (name, width) in self.windows:
            self.browser.switch_to.window(self.windows[name, width])
            return
        window = self.command("Target.createTarget", url="about:blank")["targetId"]
        self.windows[name, width] = window
        self.browser.switch_to.window(window)
        self.command("Emulation.setDeviceMetricsOverride", width=width, height=900,
                     deviceScaleFactor=1, mobile=width < 600)
        self.browser.get(self.urls[name])
        ready = "document.documentElement.dataset.ready"
        WebDriverWait(self.browser, 30).until(lambda _: self.value(ready) == "yes")

    def tearDown(self):
        """After each test the console is empty, and no page has used the network."""
        self.assertEqual([entry["message"] for entry in self.browser.get_log("browser")], [])
        local = ("data:", "blob:", *self.urls.values())
        self.assertEqual([url for url in self.requests() if not url.startswith(local)], [])

    def requests(self):
        """The requests of the pages since the last call, without those of the browser itself."""
        events = [json.loads(entry["message"])["message"]
                  for entry in self.browser.get_log("performance")]
        asked = [event["params"] for event in events
                 if event["method"] == "Network.requestWillBeSent"]
        return [one["request"]["url"] for one in asked if one["documentURL"] in self.urls.values()]

    def command(self, name, **options):
        """Runs a command of the DevTools protocol."""
        return self.browser.execute_cdp_cmd(name, options)

    def value(self, expression, *arguments):
        """The value of an expression in JavaScript."""
        return self.browser.execute_script(f"return {expression}", *arguments)

    def find(self, selector):
        """The first element that a CSS selector finds."""
        return self.browser.find_element(By.CSS_SELECTOR, selector)

    def find_all(self, selector):
        """All elements that a CSS selector finds."""
        return self.browser.find_elements(By.CSS_SELECTOR, selector)

    def chart(self, section):
        """The chart of a section."""
        return self.find(f"#{section} .chart")

    def of_traces(self, section, expression):
        """The values of an expression for each `trace` of a chart, in one list."""
        return self.value(f"arguments[0].data.flatMap((trace) => {expression})",
                          self.chart(section))

    def drawn(self, section):
        """What the chart of a section shows, as DRAWN reads it."""
        return self.browser.execute_script(DRAWN, self.chart(section))

    def select(self, section, key):
        """A filter of a section."""
        return Select(self.find(f'#{section} select[name="{key}"]'))

    def rows(self, section):
        """The number of visible rows in the table of a section."""
        rows = "[...document.querySelectorAll(arguments[0])]"
        return self.value(f"{rows}.filter((row) => !row.hidden).length", f"#{section} tbody tr")

    def assert_all_drawn(self, sections):
        """The page has a chart in each of these sections, and no other."""
        found = [chart.get_attribute("data-chart") for chart in self.find_all(".chart")]
        self.assertEqual(sorted(found), sorted(sections))
        for section in sections:
            chart = self.drawn(section)
            self.assertGreaterEqual(chart["main"], 1, section)
            self.assertGreaterEqual(chart["traces"], 1, section)
            self.assertGreaterEqual(chart["marks"], 3, section)
            self.assertGreater(chart["width"], 250, section)
            self.assertGreater(chart["height"], 150, section)

    def test_every_chart_of_the_committed_results_draws(self):
        self.open("committed")
        present = [section for section in SECTIONS + SAMPLE_SECTIONS[:2]
                   if not self.find_all(f"#{section}[data-missing]")]
        self.assertLessEqual(set(SECTIONS), set(present))
        self.assert_all_drawn(present)

    def test_charts_of_kernels_and_of_the_chain_draw(self):
        self.open("sample")
        self.assert_all_drawn(SAMPLE_SECTIONS)
        self.assertGreaterEqual(self.drawn("attribution")["marks"], 6)
        self.assertGreaterEqual(len(self.find_all("section[data-missing]")), 10)

    def test_the_roofline_opens_with_whole_rows_and_steps_and_shows_every_kernel_when_asked(self):
        def kernels():
            return set(self.of_traces("roofline", "trace.meta.kernel || []"))
        self.open("sample")
        rows = self.rows("roofline")
        self.assertEqual(kernels(), {"rk4_step", "stage_row"})
        choice = self.select("roofline", "kernel")
        choice.select_by_value("")
        self.assertEqual(kernels(), {"rk4_step", "rotation", "stage_row"})
        self.assertGreater(self.rows("roofline"), rows)
        choice.select_by_value("rotation")
        self.assertEqual(kernels(), {"rotation"})
        choice.select_by_index(0)
        self.assertEqual(self.rows("roofline"), rows)

    def test_a_rest_below_zero_points_to_the_left_and_the_step_itself_is_marked(self):
        self.open("sample")
        left = self.value("arguments[0].layout.xaxis.range[0]", self.chart("attribution"))
        self.assertLess(left, -20)
        steps = self.of_traces("attribution",
                               "trace.name === 'the step itself' ? trace.x[0] : []")
        self.assertEqual(steps, [1000, 100])
        texts = self.of_traces("attribution", "trace.hovertext || []")
        self.assertIn("bound: its instructions [ns]: 462", "".join(texts))

    def test_a_filter_changes_what_the_chart_and_its_table_show(self):
        self.open("committed")
        for section, key, value in (
                ("atlas", "verdict", "unstable"),
                ("work-precision-time", "problem", "tumbling_box damping_ratio=0"),
                ("work-precision-time", "precision", "f32"),
                ("figure-9", "curve", "NVIDIA P100"),
                ("stability", "integrator", "velocity_verlet"),
                ("ladder", "verdict", "insufficient")):
            with self.subTest(section=section, key=key):
                choice = self.select(section, key)
                first = choice.options.index(choice.first_selected_option)
                before, rows = self.drawn(section), self.rows(section)
                choice.select_by_value(value)
                after = self.drawn(section)
                self.assertGreaterEqual(after["marks"], 1)
                self.assertGreater(self.rows(section), 0)
                self.assertNotEqual(before["look"], after["look"])
                values = self.of_traces(section, f"trace.meta.{key} ?? []")
                self.assertEqual(set(values), {value})
                choice.select_by_index(first)
                self.assertEqual(self.drawn(section)["marks"], before["marks"])
                self.assertEqual(self.rows(section), rows)

    def test_a_filter_changes_a_table_of_the_paper(self):
        self.open("committed")
        for section, label, value in (("table-3", "Row", "NVIDIA P100"),
                                      ("table-3-executors", "Plate", "n=100")):
            before = self.rows(section)
            self.select(section, label).select_by_value(value)
            self.assertTrue(0 < self.rows(section) < before)
            self.select(section, label).select_by_value("")

    def test_each_cell_of_the_atlas_says_why_and_a_click_shows_its_row(self):
        self.open("committed")
        texts = self.of_traces("atlas", "trace.text")
        self.assertGreater(len(texts), 300)
        for text in texts:
            for word in ("verdict: ", "expected: ", "why: ", "tables/failures.csv:"):
                self.assertIn(word, text)
        line = self.of_traces("atlas", "trace.customdata")[0]
        self.browser.execute_script(
            "arguments[0].emit('plotly_click', {points: [{customdata: arguments[1]}]})",
            self.chart("atlas"), line)
        marked = self.find_all("#atlas tr.marked")
        self.assertEqual(len(marked), 1)
        self.assertTrue(marked[0].is_displayed())

    def test_the_theme_button_changes_page_and_charts_and_back(self):
        self.open("committed")
        def looks():
            tick = self.find("#advice .chart .xtick text")
            return self.value(BACKGROUND), self.value("getComputedStyle(arguments[0]).fill", tick)
        button, before = self.find("#theme"), looks()
        label = button.text
        self.browser.execute_script("arguments[0].scrollIntoView()", button)
        button.click()
        for old, new in zip(before, looks()):
            self.assertNotEqual(old, new)
        self.assertNotEqual(label, button.text)
        self.assertGreaterEqual(self.drawn("advice")["marks"], 3)
        button.click()
        self.assertEqual(looks(), before)

    def test_the_systems_dark_theme_is_followed(self):
        self.open("sample")
        light = self.value(BACKGROUND)
        self.command("Emulation.setEmulatedMedia",
                     features=[{"name": "prefers-color-scheme", "value": "dark"}])
        dark = self.value(BACKGROUND)
        self.command("Emulation.setEmulatedMedia", features=[])
        self.assertNotEqual(light, dark)

    def test_charts_open_with_at_most_eight_series(self):
        self.open("committed")
        for section in SECTIONS:
            names = self.of_traces(section, "trace.showlegend ? [trace.name] : []")
            self.assertLessEqual(len(set(names)), 8, (section, names))

    def test_the_contents_stay_in_view_and_name_the_chapter_that_is_read(self):
        self.open("committed", 1400)
        self.browser.execute_script("document.getElementById('pareto').scrollIntoView()")
        here = "[...document.querySelectorAll('nav [aria-current]')].map((link) => link.hash)"
        WebDriverWait(self.browser, 10).until(lambda _: self.value(here) == ["#pareto"])
        box = self.value("arguments[0].getBoundingClientRect().toJSON()", self.find("nav"))
        self.assertEqual((box["top"], box["left"] < 100), (0, True))
        for hash, is_shown in (("#pareto", True), ("#accuracy", True), ("#atlas", False)):
            self.assertEqual(self.find(f'nav a[href="{hash}"]').is_displayed(), is_shown, hash)
        self.open("committed", 360)
        is_open = "document.getElementById('contents').open"
        self.assertFalse(self.value(is_open))
        self.find("nav summary").click()
        self.assertTrue(self.value(is_open))
        self.find('nav a[href="#accuracy"]').click()
        self.assertFalse(self.value(is_open))

    def test_no_table_is_wider_than_its_column(self):
        self.open("committed", 1400)
        wide = self.browser.execute_script("""
            const all = [...document.querySelectorAll("main details")];
            const closed = all.filter((one) => !one.open);
            for (const one of closed) one.open = true;
            const wide = [...document.querySelectorAll(".scroll")]
              .filter((one) => one.scrollWidth > one.clientWidth)
              .map((one) => one.getAttribute("aria-label") + " " + one.scrollWidth);
            for (const one of closed) one.open = false;
            return wide;""")
        self.assertEqual(wide, [])

    def test_a_phone_does_not_scroll_sideways(self):
        for name, sections in (("committed", SECTIONS), ("sample", SAMPLE_SECTIONS)):
            self.open(name, 360)
            widths = self.value("[innerWidth, document.documentElement.scrollWidth]")
            self.assertEqual(widths, [360, 360], name)
            for section in sections:
                self.assertLessEqual(self.drawn(section)["width"], 360)
                self.assertGreaterEqual(self.drawn(section)["marks"], 3, section)

    def test_the_keyboard_reaches_theme_filters_tables_and_details(self):
        self.open("sample")
        self.browser.execute_script("document.activeElement.blur(); window.scrollTo(0, 0)")
        reached = []
        for _ in range(150):
            self.browser.switch_to.active_element.send_keys(Keys.TAB)
            reached.append(self.browser.execute_script(FOCUS))
            if reached[-1][0] == "BODY":
                break
        self.assertIn(["BUTTON", "theme", ""], reached)
        self.assertIn(["SELECT", "variant", "roofline"], reached)
        self.assertIn(["SELECT", "verdict", "atlas"], reached)
        self.assertTrue([at for at in reached if at[0] == "DIV" and "scroll" in at[1]
                         and at[2] == "table-1-host"], reached)
        self.assertTrue([at for at in reached if at[0] == "SUMMARY" and at[2] == "chain"], reached)
        before = self.drawn("roofline")["marks"]
        choice = self.find('#roofline select[name="variant"]')
        choice.send_keys(Keys.ARROW_DOWN)
        self.assertNotEqual(self.drawn("roofline")["marks"], before)
        choice.send_keys(Keys.ARROW_UP)

    def test_each_chart_is_also_words_and_a_table(self):
        self.open("committed")
        for section in SECTIONS:
            label = self.chart(section).get_attribute("aria-label")
            self.assertGreater(len(label), 60, section)
            cells = self.value("document.querySelectorAll(arguments[0]).length",
                               f"#{section} details tbody td")
            self.assertGreater(cells, 20, section)

    def test_the_logs_that_every_test_looks_at_are_on(self):
        self.open("sample")
        address, found = "https://example.invalid/asked.png", []
        self.browser.execute_script(
            "console.error('seen'); new Image().src = arguments[0]", address)

        def has_both(browser):
            found.extend(browser.get_log("browser"))
            return len(found) >= 2
        WebDriverWait(self.browser, 10).until(has_both)
        text = "".join(entry["message"] for entry in found)
        self.assertIn("seen", text)
        self.assertIn("Content Security Policy", text)  # the page must not ask
        self.assertIn(address, self.requests())


if __name__ == "__main__":
    report.run_tests("__main__")
