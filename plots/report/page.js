"use strict";
// Contents, theme, filters and charts of the page. plots/render/page.py made what is drawn here.
(() => {
  const root = document.documentElement;
  const specs = JSON.parse(document.getElementById("charts").textContent);
  const hasLibrary = typeof Plotly !== "undefined";
  const system = window.matchMedia("(prefers-color-scheme: dark)");

  const isDark = () => (root.dataset.theme || (system.matches ? "dark" : "light")) === "dark";
  const colour = (name) => getComputedStyle(root).getPropertyValue("--" + name).trim();
  const axesOf = (layout, letters) =>
    Object.keys(layout).filter((name) => new RegExp(`^[${letters}]axis`).test(name));

  // The choices of a section's filters, by key. "" is all values; several values have lines.
  function chosenIn(section) {
    const selects = [...section.querySelectorAll("select")];
    return Object.fromEntries(selects.map((select) => [select.name, select.value]));
  }

  const fits = (keys, chosen) => Object.entries(chosen).every(([key, value]) =>
    !value || keys[key] === undefined || value.split("\n").includes(keys[key]));

  // The layout that all charts share, in the colours of the theme, with that of the chart on top.
  function layoutOf(spec, node, entries) {
    const edge = colour("edge");
    const axis = { gridcolor: edge, zerolinecolor: edge, linecolor: edge, automargin: true };
    const isNarrow = node.clientWidth < 600;
    const size = isNarrow ? 10 : 12;
    const layout = {
      paper_bgcolor: "rgba(0,0,0,0)",
      plot_bgcolor: "rgba(0,0,0,0)",
      font: { color: colour("ink"), size, family: "system-ui, sans-serif" },
      margin: { l: 10, r: 10, t: 30, b: 10 },
      hovermode: "closest",
      hoverlabel: { align: "left", font: { size } },
      dragmode: isNarrow ? false : "zoom",
      legend: { orientation: "h", x: 0, y: 1.02, xanchor: "left", yanchor: "bottom" },
      height: spec.height + (isNarrow ? 14 : 4) * entries,
      ...spec.layout,
    };
    for (const name of axesOf(layout, "xy")) layout[name] = { ...axis, ...layout[name] };
    if (layout.xaxis.side === "top") Object.assign(layout.legend, { y: 0, yanchor: "top" });
    if (isNarrow) narrow(layout, spec.traces);
    return layout;
  }

  // A phone has no room for long names of rows: they are cut. Marks and the table have them whole.
  function narrow(layout, traces) {
    const cut = (text) => text.length > 16 ? text.slice(0, 15) + "\u2026" : text;
    for (const axis of axesOf(layout, "y").map((name) => layout[name])) {
      if (axis.type === "category") {
        const values = axis.categoryarray || [...new Set(traces.flatMap((trace) => trace.y))];
        axis.tickvals = axis.ticktext = values;
      }
      if (axis.ticktext) axis.ticktext = axis.ticktext.map(cut);
    }
    for (const axis of axesOf(layout, "x").map((name) => layout[name])) {
      if (axis.ticktext) axis.tickangle = -90;
    }
    for (const { marker } of traces.filter((trace) => trace.marker)) {
      if (Array.isArray(marker.size)) marker.size = marker.size.map((size) => 0.5 * size);
      else if (marker.size > 10) marker.size = 0.65 * marker.size;
    }
  }

  // Hides rows of the section's table. Returns the number of the others.
  function filterRows(section, chosen) {
    const rows = [...section.querySelectorAll("tr[data-keys]")];
    for (const row of rows) row.hidden = !fits(JSON.parse(row.dataset.keys), chosen);
    return rows.filter((row) => !row.hidden).length;
  }

  // Lines of at most 70 characters; further lines of one text are indented.
  function broken(words) {
    const cut = words.length > 70 ? words.lastIndexOf(" ", 70) : -1;
    return cut > 3 ? [words.slice(0, cut), ...broken("   " + words.slice(cut + 1))] : [words];
  }

  const escaped = (text) => text.replace(/&/g, "&amp;").replace(/</g, "&lt;");

  // The texts of points are the rows of the section's table: {keys, text} of each line of the file.
  // A line has several rows if it stands in several panels.
  const texts = new Map();
  function textsOf(section) {
    if (texts.has(section)) return texts.get(section);
    const [file, ...heads] = [...section.querySelectorAll("thead th")].map((th) => th.textContent);
    const found = {};
    for (const row of section.querySelectorAll("tr[data-line]")) {
      const [line, ...cells] = [...row.cells].map((cell) => cell.textContent);
      const words = heads.map((head, place) => cells[place] && head + ": " + cells[place]);
      const lines = [...words.filter(Boolean).flatMap(broken), file + line].map(escaped);
      (found[row.dataset.line] ||= []).push(
        { keys: JSON.parse(row.dataset.keys), text: lines.join("<br>") });
    }
    texts.set(section, found);
    return found;
  }

  function textOf(rows, trace) {
    const row = rows && (rows.find(({ keys }) => fits(keys, trace.meta)) || rows[0]);
    return row ? row.text : "";
  }

  // The traces that fit the choices, with texts of points, and one entry of the legend a group.
  function tracesOf(section, spec, chosen, groups) {
    const traces = spec.traces.filter((trace) => fits(trace.meta, chosen));
    const rows = textsOf(section);
    for (const trace of traces) {
      if (trace.customdata) {
        const ofPoints = trace.customdata.map((line) => textOf(rows[line], trace));
        trace[trace.type === "bar" ? "hovertext" : "text"] = ofPoints;
      }
      const group = trace.legendgroup || trace.name;
      trace.showlegend = trace.showlegend !== false && Boolean(trace.name)
        && trace.type !== "heatmap" && !groups.has(group);
      groups.add(group);
    }
    return traces;
  }

  function draw(section) {
    const chosen = chosenIn(section), node = section.querySelector(".chart");
    const output = section.querySelector("output"), rows = filterRows(section, chosen);
    if (output) output.textContent = rows + " rows";
    if (!node || !hasLibrary) return;
    const theme = { ink: colour("ink"), soft: colour("soft"), ground: colour("ground") };
    const spec = JSON.parse(JSON.stringify(specs[node.dataset.chart]),
      (key, value) => theme[value] || value);
    const groups = new Set(), traces = tracesOf(section, spec, chosen, groups);
    node.dataset.traces = traces.length;
    Plotly.react(node, traces, layoutOf(spec, node, groups.size),
      { responsive: true, displayModeBar: false });
    if (!node.dataset.listens) {
      node.dataset.listens = "yes";
      node.on("plotly_click", (event) => show(section, event.points[0].customdata));
    }
  }

  // A click on a point shows its row.
  function show(section, line) {
    const row = section.querySelector(`tr[data-line="${line}"]`);
    if (!row) return;
    section.querySelector("details").open = true;
    for (const other of section.querySelectorAll("tr.marked")) other.classList.remove("marked");
    row.classList.add("marked");
    row.scrollIntoView({ block: "center" });
  }

  const sections = [...document.querySelectorAll("section.part")];
  const button = document.getElementById("theme");
  const waiting = new Set(sections); // are drawn when they come near, or when nothing else happens

  // Safari has no requestIdleCallback.
  function whenIdle(call) {
    if (window.requestIdleCallback) requestIdleCallback(call, { timeout: 100 });
    else setTimeout(() => call({ timeRemaining: () => 0 }), 1);
  }

  function drawFirst(section) {
    if (waiting.delete(section)) draw(section);
  }

  function drawRest(deadline) {
    for (const section of waiting) {
      drawFirst(section);
      if (deadline.timeRemaining() < 10) break;
    }
    if (waiting.size) whenIdle(drawRest);
    else root.dataset.ready = "yes";
  }

  function redraw() {
    button.textContent = isDark() ? "Light theme" : "Dark theme";
    sections.filter((section) => !waiting.has(section)).forEach(draw);
  }

  // The contents are open beside the page, and closed above a narrow one. They show the parts of
  // the chapter that is read.
  const contents = document.getElementById("contents");
  const isWide = window.matchMedia("(min-width: 75rem)");
  const targetOf = (link) => document.getElementById(decodeURIComponent(link.hash.slice(1)));
  const links = [...contents.querySelectorAll("a")].filter(targetOf);
  const targets = links.map(targetOf);

  function fold() {
    contents.open = isWide.matches;
  }

  function markHere() {
    const tops = targets.map((target) => target.getBoundingClientRect().top);
    const here = links[tops.findLastIndex((top) => top < 120)];
    for (const link of links) link.removeAttribute("aria-current");
    if (here) here.setAttribute("aria-current", "location");
    for (const item of contents.querySelectorAll("li")) {
      item.classList.toggle("here", Boolean(here) && item.contains(here));
    }
  }

  let isMarking = false;
  window.addEventListener("scroll", () => {
    if (isMarking) return;
    isMarking = true;
    requestAnimationFrame(() => { isMarking = false; markHere(); });
  }, { passive: true });
  contents.addEventListener("click", (event) => {
    if (event.target.closest("a")) fold();
  });
  isWide.addEventListener("change", fold);
  fold();
  markHere();

  button.addEventListener("click", () => {
    root.dataset.theme = isDark() ? "light" : "dark";
    redraw();
  });
  system.addEventListener("change", redraw);
  // A phone may be turned.
  window.matchMedia("(max-width: 640px)").addEventListener("change", redraw);
  for (const section of sections) {
    for (const select of section.querySelectorAll("select")) {
      select.addEventListener("change", () => draw(section));
    }
  }
  for (const node of hasLibrary ? document.querySelectorAll(".chart") : []) {
    node.style.minHeight = specs[node.dataset.chart].height + "px";
  }
  const near = new IntersectionObserver((entries) => {
    for (const entry of entries) if (entry.isIntersecting) drawFirst(entry.target);
  }, { rootMargin: "600px" });
  sections.forEach((section) => near.observe(section));
  redraw();
  whenIdle(drawRest);
})();
