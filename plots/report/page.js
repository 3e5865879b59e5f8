"use strict";
// Theme, filters and charts of the page. What is drawn was made by plots/render/page.py; nothing is computed here.
(() => {
  const root = document.documentElement;
  const specs = JSON.parse(document.getElementById("charts").textContent);
  const hasLibrary = typeof Plotly !== "undefined";
  const system = window.matchMedia("(prefers-color-scheme: dark)");

  const isDark = () => (root.dataset.theme || (system.matches ? "dark" : "light")) === "dark";
  const colour = (name) => getComputedStyle(root).getPropertyValue("--" + name).trim();

  // Choices of a section's filters, by key; "" is all, and a choice of several values has a line for each.
  const chosenIn = (section) => Object.fromEntries([...section.querySelectorAll("select")].map((select) => [select.name, select.value]));
  const fits = (keys, chosen) => Object.entries(chosen).every(([key, value]) => !value || keys[key] === undefined || value.split("\n").includes(keys[key]));

  // The layout that all charts share, in the theme's colours; a chart's own goes on top.
  function layoutOf(spec, node, entries) {
    const axis = { gridcolor: colour("edge"), zerolinecolor: colour("edge"), linecolor: colour("edge"), automargin: true };
    const isNarrow = node.clientWidth < 600;
    const layout = {
      paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", font: { color: colour("ink"), size: isNarrow ? 10 : 12, family: "system-ui, sans-serif" },
      margin: { l: 10, r: 10, t: 30, b: 10 }, hovermode: "closest", hoverlabel: { align: "left", font: { size: isNarrow ? 10 : 12 } }, dragmode: isNarrow ? false : "zoom",
      legend: { orientation: "h", x: 0, y: 1.02, xanchor: "left", yanchor: "bottom" }, height: spec.height + (isNarrow ? 14 : 4) * entries,
      ...spec.layout,
    };
    for (const key of Object.keys(layout).filter((name) => /^[xy]axis/.test(name))) layout[key] = { ...axis, ...layout[key] };
    if (layout.xaxis.side === "top") Object.assign(layout.legend, { y: 0, yanchor: "top" });
    if (isNarrow) narrow(layout, spec.traces);
    return layout;
  }

  // On a phone names of rows would leave no room for the rows: they are cut, and said whole by each mark and in the table.
  function narrow(layout, traces) {
    for (const axis of Object.keys(layout).filter((key) => /^yaxis/.test(key)).map((key) => layout[key])) {
      if (axis.type === "category") axis.tickvals = axis.ticktext = axis.categoryarray || [...new Set(traces.flatMap((trace) => trace.y))];
      if (axis.ticktext) axis.ticktext = axis.ticktext.map((text) => text.length > 16 ? text.slice(0, 15) + "\u2026" : text);
    }
    for (const key of Object.keys(layout).filter((key) => /^xaxis/.test(key))) if (layout[key].ticktext) layout[key].tickangle = -90;
    for (const trace of traces.filter((one) => one.marker)) {
      const size = trace.marker.size;
      if (Array.isArray(size)) trace.marker.size = size.map((one) => 0.5 * one);
      else if (size > 10) trace.marker.size = 0.65 * size;
    }
  }

  function draw(section) {
    const chosen = chosenIn(section), node = section.querySelector(".chart"), output = section.querySelector("output");
    let rows = 0;
    for (const row of section.querySelectorAll("tr[data-keys]")) {
      row.hidden = !fits(JSON.parse(row.dataset.keys), chosen);
      rows += row.hidden ? 0 : 1;
    }
    if (output) output.textContent = rows + " rows";
    if (!node || !hasLibrary) return;
    const words = { ink: colour("ink"), soft: colour("soft"), ground: colour("ground") };
    const spec = JSON.parse(JSON.stringify(specs[node.dataset.chart]), (key, value) => words[value] || value);
    const traces = spec.traces.filter((trace) => fits(trace.meta, chosen)), seen = new Set();
    for (const trace of traces) {
      // What points say stands once for each row of the table.
      const hover = trace.type === "bar" ? "hovertext" : "text";
      if (trace.customdata && !trace[hover]) trace[hover] = trace.customdata.map((line) => spec.hovers[line]);
      const group = trace.legendgroup || trace.name;
      trace.showlegend = trace.showlegend !== false && Boolean(trace.name) && trace.type !== "heatmap" && !seen.has(group);
      seen.add(group);
    }
    node.dataset.traces = traces.length;
    Plotly.react(node, traces, layoutOf(spec, node, seen.size), { responsive: true, displayModeBar: false });
    if (!node.dataset.listens) {
      node.dataset.listens = "yes";
      node.on("plotly_click", (event) => show(section, event.points[0].customdata));
    }
  }

  // A point that is clicked shows its row.
  function show(section, line) {
    const row = section.querySelector(`tr[data-line="${line}"]`);
    if (!row) return;
    section.querySelector("details").open = true;
    section.querySelectorAll("tr.marked").forEach((other) => other.classList.remove("marked"));
    row.classList.add("marked");
    row.scrollIntoView({ block: "center" });
  }

  const sections = [...document.querySelectorAll("section.part")];
  const button = document.getElementById("theme");
  const name = () => { button.textContent = isDark() ? "Light theme" : "Dark theme"; };
  const redraw = () => { name(); sections.forEach(draw); };

  button.addEventListener("click", () => {
    root.dataset.theme = isDark() ? "light" : "dark";
    redraw();
  });
  system.addEventListener("change", redraw);
  window.matchMedia("(max-width: 640px)").addEventListener("change", redraw); // a phone that is turned
  for (const section of sections) section.querySelectorAll("select").forEach((select) => select.addEventListener("change", () => draw(section)));
  redraw();
  root.dataset.ready = "yes";
})();
