#include "solver/decomposition/decomposition_file.hpp"
#include "solver/decomposition/methods.hpp"
#include "solver/error.hpp"
#include "solver/json/object_node.hpp"
#include "solver/json/parse.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>

namespace dss {
namespace {

/// For pictures and people; most of a file.
const std::set<std::string> left_out = {"addresses", "boundary", "row_places", "bodies"};

bool is_whole(const nlohmann::json& value, double least, double most) {
  return value.is_number_integer() && value.get<double>() >= least && value.get<double>() <= most;
}

void require_number(const Node& node, std::size_t expected, const std::string& why) {
  if (!is_whole(node.json(), double(expected), double(expected)))
    node.fail(fmt::format("{} is not {}{}", node.shown(), expected, why));
}

Segment read_segment(const Node& node, const Lattice& lattice) {
  const auto is_number = [](const nlohmann::json& value) {
    return is_whole(value, 0, std::numeric_limits<int>::max());
  };
  if (!node.is_array() || node.json().size() != 3 || !std::ranges::all_of(node.json(), is_number))
    node.fail("is not [row, first x, one past the last x] in whole numbers of 0 or more");
  const Segment segment{node.json()[0], node.json()[1], node.json()[2]};
  if (std::size_t(segment.row) >= lattice.rows.size())
    node.fail(
        fmt::format("there is no row {}; rows are 0 .. {}", segment.row, lattice.rows.size() - 1));
  const Row& row = lattice.rows[std::size_t(segment.row)];
  if (segment.x_begin < row.x_begin || segment.x_end > row.x_end ||
      segment.x_begin >= segment.x_end)
    node.fail(fmt::format("[{}, {}, {}] is not a range of cells of row {}, which has x = {} .. {}",
                          segment.row, segment.x_begin, segment.x_end, segment.row, row.x_begin,
                          row.x_end - 1));
  return segment;
}

std::vector<Share> read_parts(const std::vector<Node>& parts, const CellGrid& grid) {
  std::vector<Share> shares;
  for (std::size_t index = 0; index < parts.size(); ++index) {
    ObjectNode part(parts[index]);
    part.allow({"addresses", "boundary"});
    if (const auto number = part.find("part"))
      require_number(*number, index, ": parts are in order, from 0");
    std::size_t elements = 0;
    for (const Node& segment : part.require("segments").items(1)) {
      shares.push_back({read_segment(segment, grid.lattice()), int(index)});
      elements += grid.element_count(shares.back().segment);
    }
    if (const auto own = part.find("own_elements"))
      require_number(*own, elements, ", the number of elements in the segments of this part");
    part.finish();
  }
  return shares;
}

} // namespace

Decomposition read_decomposition(const std::string& path, const Problem& problem) {
  const JsonFile file(path, parse_json_file(path, left_out));
  ObjectNode root{Node(file)};
  root.allow({"scene", "depth", "bodies", "row_places"});
  require_number(root.require("decomposition"), 1,
                 ", the version of the format that this program reads");
  const std::string whose =
      fmt::format(", as scene {} has; is this a file of another scene or size?", problem.name);
  require_number(root.require("elements"), problem.lattice.element_count, whose);
  require_number(root.require("rows"), problem.lattice.rows.size(), whose);
  const Node place = root.require("parts");
  const std::vector<Node> parts = place.items(1);
  Decomposition decomposition{root.name_or("method", "file"), int(parts.size()),
                              read_parts(parts, CellGrid(problem.lattice))};
  root.finish();
  sort_shares(decomposition.shares);
  place.placed([&] { require_fit(decomposition, problem.lattice); });
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
