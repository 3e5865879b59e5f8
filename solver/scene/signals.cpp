#include "solver/scene/signals.hpp"

#include "solver/io/series_csv.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <limits>
#include <utility>

namespace dss {
namespace {

void read_ramp(const Node& node, Signal& signal) {
  ObjectNode ramp(node);
  signal.kind = Signal::Kind::ramp;
  signal.amplitude = ramp.number_or("to", 1);
  signal.duration = ramp.require("duration").positive();
  ramp.finish();
}

void read_harmonic(const Node& node, Signal& signal) {
  ObjectNode harmonic(node);
  signal.kind = Signal::Kind::harmonic;
  signal.amplitude = harmonic.number_or("amplitude", 1);
  signal.frequency = harmonic.require("frequency").non_negative();
  signal.phase = harmonic.number_or("phase", 0);
  harmonic.finish();
}

void read_table(const Node& node, Signal& signal) {
  signal.kind = Signal::Kind::table;
  for (const Node& point : node.items()) {
    const std::vector<Node> pair = point.items();
    if (pair.size() != 2) point.fail("not [time, value]");
    const double time = pair[0].number();
    if (!signal.times.empty() && time <= signal.times.back())
      pair[0].fail(fmt::format("{} s is not after {} s; times ascend", time, signal.times.back()));
    signal.times.push_back(time);
    signal.values.push_back(pair[1].number());
  }
  if (signal.times.empty()) node.fail("the table is empty; give at least one [time, value]");
}

/// The path is relative to the scene's file unless it is absolute.
void read_series_file(const Node& node, std::string_view unit, Signal& signal) {
  ObjectNode object(node);
  const Node file = object.require("file"), column = object.require("column");
  signal.kind = Signal::Kind::table;
  signal.amplitude = object.number_or("factor", 1);
  const bool is_held = object.flag_or("hold", false);
  object.finish();
  const auto path = std::filesystem::path(node.file()).parent_path() / file.text();
  Series series = file.placed([&] { return read_series(path.string(), column.text()); });
  const bool is_factor = unit == "1" && (series.unit.empty() || series.unit == "-");
  if (!unit.empty() && series.unit != unit && !is_factor)
    column.fail(fmt::format("column \"{}\" of {} has the unit [{}]; it must be [{}]", column.text(),
                            path.string(), series.unit, unit));
  if (series.times.front() > 0)
    file.fail(fmt::format("{} begins at {:g} s; a run begins at 0 s", path.string(),
                          series.times.front()));
  if (!is_held) signal.last = series.times.back(), signal.source = path.string();
  signal.times = std::move(series.times);
  signal.values = std::move(series.values);
}

} // namespace

Signal read_signal(const Node& node, std::string_view unit) {
  Signal signal;
  if (node.is_number()) {
    signal.amplitude = node.number();
    return signal;
  }
  ObjectNode object(node);
  const std::string kind = object.require_one({"constant", "ramp", "harmonic", "table", "series"});
  const Node shape = object.require(kind);
  signal.offset = object.number_or("offset", 0);
  object.finish();
  if (kind == "constant") signal.amplitude = shape.number();
  if (kind == "ramp") read_ramp(shape, signal);
  if (kind == "harmonic") read_harmonic(shape, signal);
  if (kind == "table") read_table(shape, signal);
  if (kind == "series") read_series_file(shape, unit, signal);
  return signal;
}

Signal read_smooth_signal(const Node& node) {
  if (node.is_object() && ObjectNode(node).has("rate")) {
    ObjectNode object(node);
    Signal signal;
    signal.kind = Signal::Kind::rate;
    signal.amplitude = object.require("rate").number();
    signal.offset = object.number_or("offset", 0);
    object.finish();
    return signal;
  }
  Signal signal = read_signal(node, "rad");
  if (signal.kind == Signal::Kind::ramp)
    node.fail("a ramp has a kink, where a frame would turn in no time; give \"rate\", \"harmonic\" "
              "or a \"table\"");
  if (signal.kind != Signal::Kind::table) return signal;
  if (node.json().contains("series") && signal.last == std::numeric_limits<double>::infinity())
    node.fail("a frame that is held would stop in no time; leave \"hold\" out, and let the series "
              "last as long as the run");
  make_spline(signal);
  const auto is_finite = [](double number) { return std::isfinite(number); };
  if (!std::ranges::all_of(signal.bends, is_finite))
    node.fail("its points are too close together, or its values too large, for a smooth motion");
  return signal;
}

} // namespace dss
