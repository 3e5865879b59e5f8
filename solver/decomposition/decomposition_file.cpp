#include "solver/decomposition/decomposition_file.hpp"
#include "solver/decomposition/zones.hpp"
#include "solver/io/atomic_file.hpp"

#include <fmt/format.h>
#include <iterator>
#include <nlohmann/json.hpp>

namespace dss {
namespace {

/// Text that is written in pieces, so that a large file is never in memory as a whole.
class Writer {
public:
  explicit Writer(const std::string& path) : file_(path) {}

  template <class... Values>
  void add(fmt::format_string<Values...> form, Values&&... values) {
    text_.clear();
    fmt::format_to(std::back_inserter(text_), form, std::forward<Values>(values)...);
    file_.write(text_);
  }
  /// Writes an array; write_item writes each item.
  template <class Items, class WriteItem>
  void add_array(const Items& items, WriteItem&& write_item) {
    bool is_first = true;
    add("[");
    for (const auto& item : items) {
      if (!is_first) add(", ");
      is_first = false;
      write_item(item);
    }
    add("]");
  }
  void commit() { file_.commit(); }

private:
  AtomicFile file_;
  std::string text_;
};

std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void write_head(Writer& writer, const Problem& problem, const Decomposition& decomposition,
                int depth) {
  writer.add("{{\"decomposition\": {},\n\"scene\": {}, \"method\": {}, \"elements\": {}, \"rows\": "
             "{}, \"depth\": {},\n",
             1, quoted(problem.name), quoted(decomposition.method), problem.lattice.element_count,
             problem.lattice.rows.size(), depth);
  writer.add("\"bodies\": ");
  writer.add_array(problem.bodies, [&](const Body& body) {
    writer.add("{{\"name\": {}, \"edge\": [{}, {}, {}], \"origin\": [{}, {}, {}]}}",
               quoted(body.name), body.edge[0], body.edge[1], body.edge[2], body.origin[0],
               body.origin[1], body.origin[2]);
  });
  writer.add(",\n\"row_places\": ");
  writer.add_array(problem.lattice.rows,
                   [&](const Row& row) { writer.add("[{}, {}, {}]", row.body, row.y, row.z); });
}

void write_part(Writer& writer, const CellGrid& grid, const Zones& zones, int index) {
  const Addresses addresses(grid, zones.all);
  const auto add_runs = [&](const CellSet& set) {
    writer.add_array(addresses.runs_of(grid, set),
                     [&](const Run& run) { writer.add("[{}, {}]", run.global, run.count); });
  };
  writer.add("\n{{\"part\": {}, \"own_elements\": {},\n \"segments\": ", index,
             zones.own.cell_count());
  writer.add_array(zones.own.segments(), [&](const Segment& s) {
    writer.add("[{}, {}, {}]", s.row, s.x_begin, s.x_end);
  });
  writer.add(",\n \"addresses\": ");
  writer.add_array(addresses.runs_of(grid, zones.own), [&](const Run& run) {
    writer.add("[{}, {}, {}]", run.local, run.global, run.count);
  });
  writer.add(",\n \"boundary\": ");
  writer.add_array(zones.faces, [&](const Zones::Face& face) {
    writer.add("\n  {{\"part\": {}, \"send\": ", face.part);
    add_runs(face.send);
    writer.add(", \"receive\": ");
    add_runs(face.receive);
    writer.add("}}");
  });
  writer.add("}}");
}

} // namespace

void write_decomposition(const std::string& path, const Problem& problem,
                         const Decomposition& decomposition, int depth) {
  const CellGrid grid(problem);
  Writer writer(path);
  write_head(writer, problem, decomposition, depth);
  writer.add(",\n\"parts\": [");
  for (int index = 0; index < decomposition.parts; ++index) {
    if (index > 0) writer.add(",");
    write_part(writer, grid, find_zones(grid, decomposition, index, depth), index);
  }
  writer.add("\n]}}\n");
  writer.commit();
}

} // namespace dss
