#include "solver/decomposition/decomposition_file.hpp"
#include "solver/decomposition/methods.hpp"
#include "solver/error.hpp"
#include "solver/io/atomic_file.hpp"
#include "solver/nearest_name.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

namespace dss {
namespace {

using nlohmann::json;

/// A value of the file and its JSON pointer.
struct Place {
  const json& value;
  const std::string& file;
  std::string pointer;

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}: {}", file, pointer.empty() ? "/" : pointer, what));
  }
  /// The value as text, short enough for one line.
  std::string shown() const {
    if (value.is_structured())
      return fmt::format("an {} of {}", value.is_object() ? "object" : "array", value.size());
    const std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
    return text.size() > 60 ? text.substr(0, 57) + "..." : text;
  }
  Place operator[](const std::string& key) const {
    if (!value.contains(key)) fail(fmt::format("lacks the key \"{}\"", key));
    return {value.at(key), file, pointer + "/" + key};
  }
  Place operator[](std::size_t k) const {
    return {value.at(k), file, fmt::format("{}/{}", pointer, k)};
  }
  void require_object(const std::vector<std::string>& known) const {
    if (!value.is_object()) fail(shown() + " is not an object");
    for (const auto& item : value.items())
      if (std::find(known.begin(), known.end(), item.key()) == known.end())
        fail(fmt::format("unknown key {}; {}",
                         json(item.key()).dump(-1, ' ', true, json::error_handler_t::replace),
                         nearest_name(item.key(), known)));
  }
  void require_array(const char* of_what) const {
    if (!value.is_array() || value.empty())
      fail(fmt::format("{} is not a list of {}", shown(), of_what));
  }
  bool is_whole(double least, double most) const {
    return value.is_number_integer() && value.get<double>() >= least && value.get<double>() <= most;
  }
  void require_number(std::size_t expected, const char* why) const {
    if (!is_whole(double(expected), double(expected)))
      fail(fmt::format("{} is not {}{}", shown(), expected, why));
  }
};

/// Parses the file without the keys for pictures and people, which are most of it.
json parse(const std::string& path) {
  const std::string text = read_text(path);
  const auto is_needed = [](int depth, json::parse_event_t event, json& value) {
    if (event != json::parse_event_t::key || depth > 3) return true;
    const auto& key = value.get_ref<const std::string&>();
    return key != "addresses" && key != "boundary" && key != "row_places" && key != "bodies";
  };
  try {
    return json::parse(text, is_needed);
  } catch (const json::parse_error& error) {
    const auto end =
        text.begin() + std::ptrdiff_t(std::min(error.byte > 0 ? error.byte - 1 : 0, text.size()));
    const auto line_start = std::find(std::make_reverse_iterator(end), text.rend(), '\n').base();
    throw InputError(
        fmt::format("{}: line {}, column {}: broken JSON; something is missing or too much here",
                    path, 1 + std::count(text.begin(), end, '\n'), 1 + (end - line_start)));
  } catch (const json::exception&) {
    throw InputError(fmt::format("{}: not usable JSON: a number in it is too large", path));
  }
}

Segment read_segment(const Place& place, const Lattice& lattice) {
  constexpr double most = std::numeric_limits<int>::max();
  if (!place.value.is_array() || place.value.size() != 3 || !place[0].is_whole(0, most) ||
      !place[1].is_whole(0, most) || !place[2].is_whole(0, most))
    place.fail("is not [row, first x, one past the last x] in whole numbers of 0 or more");
  const Segment segment{place.value[0].get<int>(), place.value[1].get<int>(),
                        place.value[2].get<int>()};
  if (std::size_t(segment.row) >= lattice.rows.size())
    place.fail(
        fmt::format("there is no row {}; rows are 0 .. {}", segment.row, lattice.rows.size() - 1));
  const Row& row = lattice.rows[std::size_t(segment.row)];
  if (segment.x_begin < row.x_begin || segment.x_end > row.x_end ||
      segment.x_begin >= segment.x_end)
    place.fail(fmt::format("[{}, {}, {}] is not a range of cells of row {}, which has x = {} .. {}",
                           segment.row, segment.x_begin, segment.x_end, segment.row, row.x_begin,
                           row.x_end - 1));
  return segment;
}

std::vector<Share> read_parts(const Place& parts, const CellGrid& grid) {
  parts.require_array("parts");
  std::vector<Share> shares;
  for (std::size_t index = 0; index < parts.value.size(); ++index) {
    const Place part = parts[index];
    part.require_object({"part", "own_elements", "segments", "addresses", "boundary"});
    if (part.value.contains("part"))
      part["part"].require_number(index, ": parts are in order, from 0");
    const Place segments = part["segments"];
    segments.require_array("segments [row, first x, one past the last x]");
    std::size_t elements = 0;
    for (std::size_t k = 0; k < segments.value.size(); ++k) {
      shares.push_back({read_segment(segments[k], grid.lattice()), int(index)});
      elements += grid.element_count(shares.back().segment);
    }
    if (part.value.contains("own_elements"))
      part["own_elements"].require_number(elements,
                                          ", the number of elements in the segments of this part");
  }
  return shares;
}

} // namespace

Decomposition read_decomposition(const std::string& path, const Problem& problem) {
  const json root = parse(path);
  const Place file{root, path, ""};
  file.require_object({"decomposition", "scene", "method", "elements", "rows", "depth", "bodies",
                       "row_places", "parts"});
  file["decomposition"].require_number(1, ", the version of the format that this program reads");
  const std::string whose =
      fmt::format(", as scene {} has; is this a file of another scene or size?", problem.name);
  file["elements"].require_number(problem.lattice.element_count, whose.c_str());
  file["rows"].require_number(problem.lattice.rows.size(), whose.c_str());
  Decomposition decomposition{"file", int(file["parts"].value.size()),
                              read_parts(file["parts"], CellGrid(problem.lattice))};
  if (root.contains("method")) {
    if (!root["method"].is_string()) file["method"].fail(file["method"].shown() + " is not a name");
    decomposition.method = root["method"].get<std::string>();
  }
  sort_shares(decomposition.shares);
  try {
    require_fit(decomposition, problem.lattice);
  } catch (const InputError& error) {
    file["parts"].fail(error.what());
  }
  decomposition.shares = tidy(decomposition.shares, problem.lattice);
  return decomposition;
}

bool is_file(const std::string& method_or_file) {
  return method_or_file.find('/') != std::string::npos || method_or_file.ends_with(".json");
}

Decomposition decomposition_for(const Problem& problem, const std::string& method_or_file,
                                int ranks, const Weights& weights) {
  if (!is_file(method_or_file)) return decompose(problem, method_or_file, ranks, weights);
  Decomposition read = read_decomposition(method_or_file, problem);
  if (read.parts != ranks)
    throw InputError(fmt::format("--decomposition {}: has {} parts for {} ranks; give --ranks {}",
                                 method_or_file, read.parts, ranks, read.parts));
  return read;
}

} // namespace dss
