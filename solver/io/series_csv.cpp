#include "solver/io/series_csv.hpp"

#include "solver/error.hpp"
#include "solver/io/input_file.hpp"
#include "solver/nearest_name.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <string_view>

namespace dss {
namespace {

/// Of the median interval: more between two points is a gap.
constexpr double gap = 10;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\r";
  const std::size_t first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t comma = 0; comma != std::string_view::npos;) {
    comma = line.find(',');
    fields.push_back(trimmed(line.substr(0, comma)));
    line.remove_prefix(comma == std::string_view::npos ? line.size() : comma + 1);
  }
  return fields;
}

/// "az [m/s^2]" as its name and its unit.
struct Heading {
  std::string name, unit;
};
Heading heading_of(std::string_view text) {
  if (text.size() > 1 && text.starts_with('"') && text.ends_with('"'))
    text = text.substr(1, text.size() - 2);
  const std::size_t bracket = text.find('[');
  if (bracket == std::string_view::npos || !text.ends_with(']')) return {std::string(text), ""};
  return {std::string(trimmed(text.substr(0, bracket))),
          std::string(trimmed(text.substr(bracket + 1, text.size() - bracket - 2)))};
}

/// Reads a file line by line. Every error says where.
class SeriesReader {
public:
  explicit SeriesReader(const std::string& path)
      : path_(path),
        file_(open_whole(path, 2, fmt::format("the series of {}", path), "give a shorter one")) {
    if (!file_.is_open()) throw InputError(fmt::format("series file {} cannot be read", path));
  }

  /// The next line that has fields; false at the end of the file.
  bool next(std::vector<std::string_view>& fields) {
    while (std::getline(file_, line_)) {
      constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
      if (++number_ == 1 && line_.starts_with(byte_order_mark))
        line_.erase(0, byte_order_mark.size());
      if (trimmed(line_).empty() || line_.front() == '#') continue;
      fields = fields_of(line_);
      return true;
    }
    return false;
  }
  double number(std::string_view field, const std::string& column) const {
    double value = 0;
    if (field.size() > 1 && field.front() == '+') field.remove_prefix(1);
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc{} || end != field.data() + field.size() || !std::isfinite(value))
      fail(field.empty() ? fmt::format("has no value of \"{}\"", column)
                         : fmt::format("\"{}\" of column \"{}\" is no number", field, column));
    return value;
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}, line {}: {}", path_, number_, what));
  }

private:
  std::string path_;
  std::ifstream file_;
  std::string line_;
  long number_ = 0;
};

void require_no_gap(const std::string& path, const std::vector<double>& times) {
  std::vector<double> intervals;
  for (std::size_t k = 1; k < times.size(); ++k) intervals.push_back(times[k] - times[k - 1]);
  if (intervals.empty()) return;
  std::vector<double> sorted = intervals;
  const auto median = sorted.begin() + std::ptrdiff_t(sorted.size() / 2);
  std::nth_element(sorted.begin(), median, sorted.end());
  const auto wide =
      std::ranges::find_if(intervals, [&](double interval) { return interval > gap * *median; });
  if (wide == intervals.end()) return;
  const auto k = std::size_t(wide - intervals.begin());
  throw InputError(fmt::format("{}: there is a gap from {:g} to {:g} s, {:.3g} times the usual "
                               "interval; fill it in",
                               path, times[k], times[k + 1], *wide / *median));
}

} // namespace

Series read_series(const std::string& path, const std::string& column) {
  SeriesReader reader(path);
  std::vector<std::string_view> fields;
  if (!reader.next(fields)) throw InputError(fmt::format("series file {} is empty", path));
  std::vector<std::string> names;
  Series series;
  for (const std::string_view field : fields) {
    const Heading heading = heading_of(field);
    if (names.empty() && heading.unit != "s")
      reader.fail(fmt::format("the first column is \"{}\"; it must be the time, with its unit: "
                              "\"t [s]\"",
                              field));
    if (std::ranges::find(names, heading.name) != names.end())
      reader.fail(fmt::format("two columns are named \"{}\"; names differ", heading.name));
    if (heading.name == column) series.unit = heading.unit;
    names.push_back(heading.name);
  }
  const auto found = std::ranges::find(names.begin() + 1, names.end(), column);
  if (found == names.end())
    reader.fail(fmt::format("there is no column \"{}\"; {}", column,
                            nearest_name(column, {names.begin() + 1, names.end()})));
  const auto place = std::size_t(found - names.begin());
  while (reader.next(fields)) {
    if (fields.size() != names.size())
      reader.fail(fmt::format("has {} values; the header has {}", fields.size(), names.size()));
    const double time = reader.number(fields[0], names[0]);
    if (!series.times.empty() && time <= series.times.back())
      reader.fail(fmt::format("{} s is not after {} s; times ascend", time, series.times.back()));
    series.times.push_back(time);
    series.values.push_back(reader.number(fields[place], column));
  }
  if (series.times.empty()) throw InputError(fmt::format("series file {} has no values", path));
  require_no_gap(path, series.times);
  return series;
}

} // namespace dss
