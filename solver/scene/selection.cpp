#include "solver/scene/selection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

namespace dss {

const std::vector<std::string> face_names = {"-x", "+x", "-y", "+y", "-z", "+z"};

namespace {

/// First and last index along each axis, both inclusive.
struct Range {
  std::array<int, 3> first, last;
  bool holds_row(int y, int z) const {
    return first[1] <= y && y <= last[1] && first[2] <= z && z <= last[2];
  }
};

Range extent_of(const Lattice& lattice, int body) {
  constexpr int least = std::numeric_limits<int>::min(), most = std::numeric_limits<int>::max();
  Range extent{{most, most, most}, {least, least, least}};
  for (const Row& row : lattice.rows) {
    if (row.body != body) continue;
    const std::array<int, 3> low = {row.x_begin, row.y, row.z},
                             high = {row.x_end - 1, row.y, row.z};
    for (std::size_t a = 0; a < 3; ++a) {
      extent.first[a] = std::min(extent.first[a], low[a]);
      extent.last[a] = std::max(extent.last[a], high[a]);
    }
  }
  return extent;
}

std::vector<std::size_t> elements_in(const Lattice& lattice, int body, const Range& range) {
  std::vector<std::size_t> elements;
  for (const Row& row : lattice.rows) {
    if (row.body != body || !range.holds_row(row.y, row.z)) continue;
    std::size_t element = row.first_element;
    for (int x = row.x_begin; x < std::min(row.x_end, range.last[0] + 1); ++x) {
      if (!lattice.is_present(row, x)) continue;
      if (x >= range.first[0]) elements.push_back(element);
      ++element;
    }
  }
  return elements;
}

Range read_face(const Node& node, const std::string& body, Range range) {
  const std::string name = node.text();
  const auto face = std::find(face_names.begin(), face_names.end(), name);
  if (face == face_names.end())
    node.fail(fmt::format("\"{}\" is not a face of body \"{}\"; faces are {}", name, body,
                          listed(face_names)));
  const auto number = std::size_t(face - face_names.begin()), axis = number / 2;
  if (number % 2 == 0)
    range.last[axis] = range.first[axis];
  else
    range.first[axis] = range.last[axis];
  return range;
}

Range read_box(const Node& node, const std::string& body, Range range) {
  ObjectNode box(node);
  for (std::size_t a = 0; a < 3; ++a) {
    const auto side = box.find(std::string(1, "xyz"[a]));
    if (!side) continue;
    constexpr long most = std::numeric_limits<int>::max();
    const int end = range.last[a];
    if (side->is_array()) {
      const std::vector<Node> ends = side->items();
      if (ends.size() != 2)
        side->fail("not [first, last], the indices of the first and the last element");
      range.first[a] = int(ends[0].whole(0, most));
      range.last[a] = int(ends[1].whole(0, most));
      if (range.first[a] > range.last[a])
        side->fail(
            fmt::format("[{}, {}] is empty; write [first, last]", range.first[a], range.last[a]));
    } else {
      range.first[a] = range.last[a] = int(side->whole(0, most));
    }
    if (range.last[a] > end)
      side->fail(fmt::format("{} is beyond the last element of body \"{}\", {} along {}",
                             range.last[a], body, end, "xyz"[a]));
  }
  box.finish();
  return range;
}

std::vector<std::size_t> read_list(const Node& node, const Problem& problem, int body) {
  std::vector<std::size_t> elements;
  for (const Node& item : node.items()) {
    item.vector(); // checks the shape of the array
    const std::vector<Node> parts = item.items();
    std::array<int, 3> cell{};
    for (std::size_t a = 0; a < 3; ++a)
      cell[a] = int(parts[a].whole(0, std::numeric_limits<int>::max()));
    const std::vector<Row>& rows = problem.lattice.rows;
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const Row& r) {
      return r.body == body && r.y == cell[1] && r.z == cell[2];
    });
    if (row == rows.end() || !problem.lattice.is_present(*row, cell[0]))
      item.fail(fmt::format("body \"{}\" has no element at [{}, {}, {}]",
                            problem.bodies[std::size_t(body)].name, cell[0], cell[1], cell[2]));
    std::size_t element = row->first_element;
    for (int x = row->x_begin; x < cell[0]; ++x) element += problem.lattice.is_present(*row, x);
    if (std::find(elements.begin(), elements.end(), element) != elements.end())
      item.fail(fmt::format("element [{}, {}, {}] is listed twice", cell[0], cell[1], cell[2]));
    elements.push_back(element);
  }
  return elements;
}

std::vector<std::size_t> read_material(const Node& node, const Problem& problem, int body) {
  const auto material = node.whole(1, 255);
  std::vector<std::size_t> elements;
  problem.lattice.for_each_element([&](std::size_t element, const Row& row, int) {
    if (row.body == body && problem.material(element) == material) elements.push_back(element);
  });
  return elements;
}

} // namespace

int read_body(ObjectNode& object, const Problem& problem) {
  const auto node = object.find("body");
  if (!node && problem.bodies.size() == 1) return 0;
  std::vector<std::string> names;
  for (const Body& body : problem.bodies) names.push_back(body.name);
  if (!node)
    object.fail(fmt::format("\"body\" is missing; the scene has several: {}", listed(names)));
  return int(node->choice("body", names));
}

std::vector<std::size_t> read_selection(ObjectNode& select, const Problem& problem, int body,
                                        const BodySurfaces& surfaces) {
  std::vector<std::string> keys = {"face", "box", "elements", "all", "material"};
  keys.insert(keys.end(), place_keys.begin(), place_keys.end());
  const std::string key = select.require_one(keys);
  const Node what = select.require(key);
  const std::string& name = problem.bodies[std::size_t(body)].name;
  std::vector<std::size_t> elements;
  if (key == "elements") {
    elements = read_list(what, problem, body);
  } else if (key == "material") {
    elements = read_material(what, problem, body);
  } else if (std::ranges::find(place_keys, key) != place_keys.end()) {
    elements = read_place(key, what, problem, body, surfaces[std::size_t(body)]);
  } else {
    Range range = extent_of(problem.lattice, body);
    if (key == "face") range = read_face(what, name, range);
    if (key == "box") range = read_box(what, name, range);
    if (key == "all" && !what.flag()) what.fail("only true has a meaning here");
    elements = elements_in(problem.lattice, body, range);
  }
  if (elements.empty())
    what.fail(fmt::format(
        "selects nothing: body \"{}\" has no element there; a selection needs at least one", name));
  return elements;
}

std::optional<std::size_t> selected_face(ObjectNode& object) {
  const auto select = object.find("select");
  if (!select) return std::nullopt;
  const auto face = ObjectNode(*select).find("face");
  if (!face) return std::nullopt;
  return face->choice("face", face_names);
}

std::vector<std::size_t> read_selected(ObjectNode& object, const Problem& problem,
                                       const BodySurfaces& surfaces, bool is_all_by_default) {
  const int body = read_body(object, problem);
  if (is_all_by_default && !object.find("select"))
    return elements_in(problem.lattice, body, extent_of(problem.lattice, body));
  ObjectNode select(object.require("select"));
  std::vector<std::size_t> elements = read_selection(select, problem, body, surfaces);
  select.finish();
  std::sort(elements.begin(), elements.end());
  return elements;
}

} // namespace dss
