"""The report in headless Chromium, opened from disk: it draws, filters, changes its theme, fits a phone, and asks no network."""
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

# What is to be seen of a chart: marks of its traces that have a size.
DRAWN = """
const chart = arguments[0], seen = (selector) => [...chart.querySelectorAll(selector)].filter((mark) => {
  const box = mark.getBoundingClientRect();
  return box.width + box.height > 0;
}).length;
const look = [...chart.querySelectorAll(".scatterlayer path, .barlayer path, .heatmaplayer image")]
  .map((mark) => (mark.getAttribute("transform") || "") + (mark.getAttribute("d") || mark.getAttribute("href") || "")).join();
return {look, main: chart.querySelectorAll("svg.main-svg").length, traces: Number(chart.dataset.traces),
        marks: seen(".scatterlayer .trace path, .barlayer .point path, .heatmaplayer image"),
        width: chart.getBoundingClientRect().width, height: chart.getBoundingClientRect().height};
"""
SECTIONS = ["speedups-1-host", "speedups-1", "speedups-2", "speedups-3", "figure-9", "work-precision-time", "work-precision-evaluations", "pareto", "scaling-1", "scaling-2", "cluster",
            "cluster-nodes", "balance", "stability", "energy", "ladder", "ladder-errors", "atlas", "advice", "error-budget", "continuum", "statics"]
SAMPLE_SECTIONS = ["chain", "roofline", "attribution", "atlas", "speedups-1-host"]


class BrowserTest(unittest.TestCase):
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
        for argument in ("--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--window-size=1280,900", "--no-first-run",
                         "--disable-background-networking", "--disable-component-update", f"--user-data-dir={directory / 'profile'}"):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        os.environ["no_proxy"] = "localhost,127.0.0.1"  # the driver is here, whatever proxy leads elsewhere
        cls.browser = webdriver.Chrome(service=Service(DRIVER), options=options)
        cls.addClassCleanup(cls.browser.quit)
        cls.windows = {}

    def open(self, name, width=1280):
        """The page at a width, in a window of its own that stays."""
        if (name, width) in self.windows:
            self.browser.switch_to.window(self.windows[name, width])
        else:
            self.windows[name, width] = self.browser.execute_cdp_cmd("Target.createTarget", {"url": "about:blank"})["targetId"]
            self.browser.switch_to.window(self.windows[name, width])
            self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 600})
            self.browser.get(self.urls[name])
            WebDriverWait(self.browser, 30).until(lambda browser: browser.execute_script("return document.documentElement.dataset.ready") == "yes")

    def tearDown(self):
        """Whatever a test does, the console stays empty and no network is asked."""
        self.assertEqual([entry["message"] for entry in self.browser.get_log("browser")], [])
        self.assertEqual([url for url in self.requests() if url not in self.urls.values() and not url.startswith(("data:", "blob:"))], [])

    def requests(self):
        """What our pages have asked for since this was last looked at; not what the browser asks for itself."""
        events = [json.loads(entry["message"])["message"] for entry in self.browser.get_log("performance")]
        asked = [event["params"] for event in events if event["method"] == "Network.requestWillBeSent"]
        return [one["request"]["url"] for one in asked if one["documentURL"] in self.urls.values()]

    def chart(self, section):
        return self.browser.find_element(By.CSS_SELECTOR, f"#{section} .chart")

    def drawn(self, section):
        return self.browser.execute_script(DRAWN, self.chart(section))

    def select(self, section, key):
        return Select(self.browser.find_element(By.CSS_SELECTOR, f'#{section} select[name="{key}"]'))

    def rows(self, section):
        return self.browser.execute_script("return [...document.querySelectorAll(arguments[0])].filter((row) => !row.hidden).length", f"#{section} tbody tr")

    def assert_all_drawn(self, sections):
        found = [chart.get_attribute("data-chart") for chart in self.browser.find_elements(By.CSS_SELECTOR, ".chart")]
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
        present = [section for section in SECTIONS + SAMPLE_SECTIONS[:3] if not self.browser.find_elements(By.CSS_SELECTOR, f"#{section}[data-missing]")]
        self.assertLessEqual(set(SECTIONS), set(present))  # what is committed stays there
        self.assert_all_drawn(present)

    def test_charts_of_kernels_and_of_the_chain_draw(self):
        self.open("sample")
        self.assert_all_drawn(SAMPLE_SECTIONS)
        self.assertGreaterEqual(self.drawn("attribution")["marks"], 6)
        self.assertGreaterEqual(len(self.browser.find_elements(By.CSS_SELECTOR, "section[data-missing]")), 10)

    def test_the_roofline_opens_with_whole_rows_and_steps_and_shows_every_kernel_when_asked(self):
        self.open("sample")
        kernels, rows = "return [...new Set(arguments[0].data.map((trace) => trace.meta.kernel).filter((name) => name))].sort()", self.rows("roofline")
        self.assertEqual(self.browser.execute_script(kernels, self.chart("roofline")), ["rk4_step", "stage_row"])
        choice = self.select("roofline", "kernel")
        choice.select_by_value("")
        self.assertEqual(self.browser.execute_script(kernels, self.chart("roofline")), ["rk4_step", "rotation", "stage_row"])
        self.assertGreater(self.rows("roofline"), rows)
        choice.select_by_value("rotation")
        self.assertEqual(self.browser.execute_script(kernels, self.chart("roofline")), ["rotation"])
        choice.select_by_index(0)
        self.assertEqual(self.rows("roofline"), rows)

    def test_a_rest_below_zero_points_to_the_left_and_the_step_itself_is_marked(self):
        self.open("sample")
        chart = self.chart("attribution")
        self.assertLess(self.browser.execute_script("return arguments[0].layout.xaxis.range[0]", chart), -20)
        self.assertEqual(self.browser.execute_script("return arguments[0].data.filter((trace) => trace.name === 'the step itself').map((trace) => trace.x[0])", chart), [1000, 100])
        self.assertIn("bound: its instructions [ns]: 462", self.browser.execute_script("return arguments[0].data.flatMap((trace) => trace.hovertext || []).join()", chart))

    def test_a_filter_changes_what_the_chart_and_its_table_show(self):
        self.open("committed")
        for section, key, value in (("atlas", "verdict", "unstable"), ("work-precision-time", "problem", "tumbling_box damping_ratio=0"),
                                    ("work-precision-time", "precision", "f32"), ("scaling-1", "variant", "avx2"),
                                    ("stability", "integrator", "velocity_verlet"), ("ladder", "verdict", "insufficient")):
            choice = self.select(section, key)
            before, first = (self.drawn(section), self.rows(section)), choice.first_selected_option.get_attribute("value")
            choice.select_by_value(value)
            after = (self.drawn(section), self.rows(section))
            self.assertGreaterEqual(after[0]["marks"], 1, (section, key))
            self.assertGreater(after[1], 0, (section, key))
            self.assertNotEqual(before[0]["look"], after[0]["look"], (section, key))
            names = self.browser.execute_script("return arguments[0].data.map((trace) => trace.meta[arguments[1]]).filter((value) => value !== undefined)", self.chart(section), key)
            self.assertEqual(set(names), {value}, (section, key))
            choice.select_by_value(first)
            self.assertEqual((self.drawn(section)["marks"], self.rows(section)), (before[0]["marks"], before[1]), (section, key))

    def test_a_filter_changes_a_table_of_the_paper(self):
        self.open("committed")
        before = self.rows("table-3")
        self.select("table-3", "Plate").select_by_value("n=100")
        self.assertTrue(0 < self.rows("table-3") < before)
        self.select("table-3", "Plate").select_by_value("")

    def test_each_cell_of_the_atlas_says_why_and_a_click_shows_its_row(self):
        self.open("committed")
        texts = self.browser.execute_script("return arguments[0].data.flatMap((trace) => trace.text)", self.chart("atlas"))
        self.assertGreater(len(texts), 300)
        for text in texts:
            for word in ("verdict: ", "expected: ", "why: ", "tables/failures.csv:"):
                self.assertIn(word, text)
        self.browser.execute_script("const chart = arguments[0]; chart.emit('plotly_click', {points: [{customdata: chart.data[0].customdata[0]}]})", self.chart("atlas"))
        marked = self.browser.find_elements(By.CSS_SELECTOR, "#atlas tr.marked")
        self.assertEqual(len(marked), 1)
        self.assertTrue(marked[0].is_displayed())

    def test_the_theme_button_changes_page_and_charts_and_back(self):
        self.open("committed")
        look = "return [getComputedStyle(document.body).backgroundColor, getComputedStyle(document.querySelector('#advice .chart .xtick text')).fill]"
        button, before = self.browser.find_element(By.ID, "theme"), self.browser.execute_script(look)
        label = button.text
        self.browser.execute_script("arguments[0].scrollIntoView()", button)
        button.click()
        after = self.browser.execute_script(look)
        self.assertNotEqual(before[0], after[0])
        self.assertNotEqual(before[1], after[1])
        self.assertNotEqual(label, button.text)
        self.assertGreaterEqual(self.drawn("advice")["marks"], 3)
        button.click()
        self.assertEqual(self.browser.execute_script(look), before)

    def test_the_systems_dark_theme_is_followed(self):
        self.open("sample")
        colour = "return getComputedStyle(document.body).backgroundColor"
        light = self.browser.execute_script(colour)
        self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": "dark"}]})
        dark = self.browser.execute_script(colour)
        self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})
        self.assertNotEqual(light, dark)

    def test_a_phone_does_not_scroll_sideways(self):
        for name, sections in (("committed", SECTIONS), ("sample", SAMPLE_SECTIONS)):
            self.open(name, 360)
            self.assertEqual(self.browser.execute_script("return [innerWidth, document.documentElement.scrollWidth]"), [360, 360], name)
            for section in sections:
                self.assertLessEqual(self.drawn(section)["width"], 360)
                self.assertGreaterEqual(self.drawn(section)["marks"], 3, section)

    def test_the_keyboard_reaches_theme_filters_tables_and_details(self):
        self.open("sample")
        self.browser.execute_script("document.activeElement.blur(); window.scrollTo(0, 0)")
        reached = []
        for _ in range(150):
            self.browser.switch_to.active_element.send_keys(Keys.TAB)
            reached.append(self.browser.execute_script("const at = document.activeElement; return [at.tagName, at.id || at.name || at.className, at.closest('section') ? at.closest('section').id : '']"))
            if reached[-1][0] == "BODY":
                break
        self.assertIn(["BUTTON", "theme", ""], reached)
        self.assertIn(["SELECT", "variant", "roofline"], reached)
        self.assertIn(["SELECT", "verdict", "atlas"], reached)
        self.assertTrue([at for at in reached if at[0] == "DIV" and "scroll" in at[1] and at[2] == "table-1-host"], reached)
        self.assertTrue([at for at in reached if at[0] == "SUMMARY" and at[2] == "chain"], reached)
        before, choice = self.drawn("roofline")["marks"], self.browser.find_element(By.CSS_SELECTOR, '#roofline select[name="variant"]')
        choice.send_keys(Keys.ARROW_DOWN)
        self.assertNotEqual(self.drawn("roofline")["marks"], before)
        choice.send_keys(Keys.ARROW_UP)

    def test_each_chart_is_also_words_and_a_table(self):
        self.open("committed")
        for section in SECTIONS:
            self.assertGreater(len(self.chart(section).get_attribute("aria-label")), 60, section)
            self.assertGreater(self.browser.execute_script("return document.querySelectorAll(arguments[0]).length", f"#{section} details tbody td"), 20, section)

    def test_the_logs_that_every_test_looks_at_are_on(self):
        self.open("sample")
        self.browser.execute_script("console.error('seen'); const image = new Image(); image.src = 'https://example.invalid/asked.png'")
        found = []
        WebDriverWait(self.browser, 10).until(lambda browser: found.extend(browser.get_log("browser")) or len(found) >= 2)
        self.assertTrue([entry for entry in found if "seen" in entry["message"]])
        self.assertTrue([entry for entry in found if "Content Security Policy" in entry["message"]])  # and the page may not ask
        self.assertIn("https://example.invalid/asked.png", self.requests())


if __name__ == "__main__":
    report.run_tests("__main__")
