#include "experiments/studies/paper/paper_study.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss {
namespace {

/// An object of texts and whole numbers.
Where read_where(ObjectNode& object, const char* key) {
  Where where;
  if (const auto node = object.find(key))
    for (const auto& [column, value] : ObjectNode(*node).members())
      where[column] = value.is_number() ? fmt::format("{}", value.whole(1)) : value.text();
  return where;
}

std::vector<PaperWay> read_ways(const Node& node) {
  std::vector<PaperWay> ways;
  for (const Node& item : node.items(1)) {
    ObjectNode way(item);
    ways.push_back(
        {way.require("way").name(), read_where(way, "where"), read_where(way, "simulated")});
    way.finish();
  }
  return ways;
}

PaperCell read_cell(const Node& node, const std::vector<PaperCell>& earlier) {
  ObjectNode object(node);
  PaperCell cell;
  cell.column = object.require("column").name();
  cell.paper = object.require("paper").positive();
  cell.is_base = object.flag_or("is_base", false);
  cell.where = read_where(object, "where");
  cell.speedup_of = object.name_or("speedup_of", "");
  object.finish();
  if (cell.speedup_of.empty()) return cell;
  const auto divided = std::ranges::find(earlier, cell.speedup_of, &PaperCell::column);
  if (divided == earlier.end())
    object.require("speedup_of")
        .fail(fmt::format("no cell before this one has the column \"{}\"", cell.speedup_of));
  cell.where = divided->where;
  return cell;
}

PaperLine read_row(const Node& node, const std::vector<PaperWay>& ways) {
  ObjectNode object(node);
  PaperLine row;
  row.name = object.require("row").name();
  row.ways = object.has("ways") ? read_ways(object.require("ways")) : ways;
  if (row.ways.empty()) object.fail("lacks the key \"ways\", and so does the table");
  for (const Node& item : object.require("cells").items(1))
    row.cells.push_back(read_cell(item, row.cells));
  object.finish();
  return row;
}

void read_simulated(ObjectNode& object, PaperStudy& study) {
  const auto node = object.find("simulated");
  if (!node) return;
  ObjectNode simulated(*node);
  study.simulated = simulated.require("table").name();
  study.simulated_where = read_where(simulated, "where");
  simulated.finish();
}

} // namespace

PaperStudy read_paper_study(const StudyFile& file) {
  ObjectNode(file.scale).finish();
  ObjectNode object(file.part("paper_table"));
  PaperStudy study;
  study.name = file.name, study.title = file.title, study.scale = file.scale_name;
  study.source = object.require("source").name();
  study.measured = object.require("measured").name();
  study.elsewhere = object.name_or("elsewhere", "");
  study.figure = object.name_or("figure", "");
  study.steps = double(object.require("steps").whole(1));
  study.bases = object.names_or("bases", {});
  read_simulated(object, study);
  const std::vector<PaperWay> ways =
      object.has("ways") ? read_ways(object.require("ways")) : std::vector<PaperWay>{};
  for (const Node& item : object.require("rows").items(1))
    study.rows.push_back(read_row(item, ways));
  object.finish();
  return study;
}

} // namespace dss
