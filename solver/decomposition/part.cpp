#include "solver/decomposition/part.hpp"
#include "solver/decomposition/zones.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace dss {
namespace {

/// Local numbers of the given elements that are in this part, in their order.
std::vector<std::size_t> restricted(const std::vector<std::size_t>& elements,
                                    const Addresses& addresses) {
  std::vector<std::size_t> here;
  for (const std::size_t element : elements)
    if (const auto local = addresses.local(element)) here.push_back(*local);
  return here;
}

std::vector<std::size_t> local_elements(const std::vector<Run>& runs) {
  std::vector<std::size_t> elements;
  for (const Run& run : runs)
    for (std::size_t k = 0; k < run.count; ++k) elements.push_back(run.local + k);
  return elements;
}

/// Rows of the elements of a set, without their neighbour rows.
/// @param global_row  output: row of the original lattice, for each row
Lattice cut_rows(const CellGrid& grid, const CellSet& set, std::vector<int>& global_row) {
  Lattice lattice;
  grid.for_each_run(set, [&](const Segment& run, std::size_t) {
    if (global_row.empty() || global_row.back() != run.row) {
      const Row& original = grid.row(run.row);
      Row row;
      row.body = original.body;
      row.y = original.y;
      row.z = original.z;
      row.x_begin = row.x_end = run.x_begin;
      row.first_element = lattice.element_count;
      row.first_cell = lattice.present.size();
      lattice.rows.push_back(row);
      global_row.push_back(run.row);
    }
    Row& row = lattice.rows.back();
    lattice.present.resize(lattice.present.size() + std::size_t(run.x_begin - row.x_end), 0);
    lattice.present.resize(lattice.present.size() + std::size_t(run.x_end - run.x_begin), 1);
    row.x_end = run.x_end;
    lattice.element_count += std::size_t(run.x_end - run.x_begin);
  });
  return lattice;
}

/// Sets neighbour rows: two rows are neighbours if they are in the original and both are here.
void join_rows(Lattice& lattice, const Lattice& original, const std::vector<int>& global_row) {
  const auto local_row = [&](int global) {
    const auto found = std::lower_bound(global_row.begin(), global_row.end(), global);
    return found != global_row.end() && *found == global ? int(found - global_row.begin()) : -1;
  };
  for (std::size_t r = 0; r < global_row.size(); ++r)
    for (int Row::*side : {&Row::lower_y, &Row::upper_y, &Row::lower_z, &Row::upper_z}) {
      const int beside = original.rows[std::size_t(global_row[r])].*side;
      lattice.rows[r].*side = beside < 0 ? -1 : local_row(beside);
    }
}

/// Copies clamps, loads, extra links and initial motions of the elements in this part. Loads and
/// motions without elements here stay in the lists, so that their numbers are the same in every
/// part.
void restrict_terms(const Problem& original, const Addresses& addresses, Problem& problem) {
  for (const Clamp& clamp : original.clamps)
    if (const auto element = addresses.local(clamp.element))
      problem.clamps.push_back({*element, clamp.dofs, clamp.at_faces});
  for (const Load& load : original.loads)
    problem.loads.push_back({restricted(load.elements, addresses), load.force, load.torque,
                             load.signal, load.face_strain, load.face});
  problem.has_damped_links_elsewhere = original.has_damped_links_elsewhere;
  for (ExtraLink link : original.extra_links) {
    problem.has_damped_links_elsewhere =
        problem.has_damped_links_elsewhere || link.constants.is_damped();
    const auto i = addresses.local(link.i), j = addresses.local(link.j);
    if (!i || !j) continue;
    link.i = *i;
    link.j = *j;
    problem.extra_links.push_back(link);
  }
  for (const InitialMotion& motion : original.initial_motions) {
    problem.initial_motions.push_back({restricted(motion.elements, addresses), motion.displacement,
                                       motion.rotation, motion.velocity, motion.angular_velocity,
                                       motion.is_rigid, motion.centre});
  }
}

/// Copies everything that is the same in every part.
void copy_common(const Problem& original, Problem& problem) {
  problem.name = original.name;
  problem.bodies = original.bodies;
  problem.stabilization = original.stabilization;
  problem.frame_acceleration = original.frame_acceleration;
  problem.frame_rotation = original.frame_rotation;
  problem.dt = original.dt;
  problem.steps = original.steps;
  problem.integrator = original.integrator;
  problem.tolerance_f64 = original.tolerance_f64;
  problem.tolerance_f32 = original.tolerance_f32;
}

/// Copies the kinds of the elements in this part.
template <class Kinds>
void copy_kinds(const Kinds& original, const Addresses& addresses, Kinds& kinds) {
  if (original.empty()) return;
  for (const Run& run : addresses.runs()) {
    const auto first = original.begin() + std::ptrdiff_t(run.global);
    kinds.insert(kinds.end(), first, first + std::ptrdiff_t(run.count));
  }
}

} // namespace

Part make_part(const Problem& problem, const Decomposition& decomposition, int index, int depth) {
  const CellGrid grid(problem);
  const Zones zones = find_zones(grid, decomposition, index, depth);
  const Addresses addresses(grid, zones.all);
  Part part;
  part.index = index;
  part.depth = depth;
  part.problem.lattice = cut_rows(grid, zones.all, part.global_row);
  join_rows(part.problem.lattice, problem.lattice, part.global_row);
  copy_common(problem, part.problem);
  copy_kinds(problem.link_kinds, addresses, part.problem.link_kinds);
  copy_kinds(problem.pressure_kinds, addresses, part.problem.pressure_kinds);
  copy_kinds(problem.materials, addresses, part.problem.materials);
  restrict_terms(problem, addresses, part.problem);
  part.own_elements = zones.own.cell_count();
  part.runs = addresses.runs_of(grid, zones.own);
  part.layer.assign(addresses.element_count(), 0);
  for (std::size_t k = 0; k < zones.layers.size(); ++k)
    for (const Run& run : addresses.runs_of(grid, zones.layers[k]))
      std::fill_n(part.layer.begin() + std::ptrdiff_t(run.local), run.count, std::uint8_t(k + 1));
  for (const Zones::Face& face : zones.faces)
    part.neighbours.push_back({face.part, local_elements(addresses.runs_of(grid, face.send)),
                               local_elements(addresses.runs_of(grid, face.receive))});
  return part;
}

/// Measures what a part computes, row by row.
static void measure_rows(const Lattice& lattice, const Zones& zones, PartSize& size) {
  struct RowCells {
    std::size_t layer = 0, own = 0, all = 0;
    bool has_halo = false;
  };
  std::map<int, RowCells> rows;
  for (std::size_t layer = 0; layer <= zones.layers.size(); ++layer)
    for (const Segment& segment : (layer == 0 ? zones.own : zones.layers[layer - 1]).segments()) {
      RowCells& row = rows.try_emplace(segment.row, RowCells{layer}).first->second;
      // All cells of these sets are present.
      const auto cells = std::size_t(segment.x_end - segment.x_begin);
      row.all += cells;
      if (layer == 0) row.own += cells;
      row.has_halo |= layer > 0;
    }
  size.row_elements.assign(zones.layers.size() + 1, 0);
  for (const auto& [r, row] : rows) {
    size.row_elements[row.layer] += row.all;
    const Row& place = lattice.rows[std::size_t(r)];
    const bool reads_halo = std::ranges::any_of(
        std::array{r, place.lower_y, place.upper_y, place.lower_z, place.upper_z}, [&](int beside) {
          const auto found = rows.find(beside);
          return found != rows.end() && found->second.has_halo;
        });
    if (!reads_halo) size.inner_elements += row.own;
  }
}

PartSize part_size(const Problem& problem, const Decomposition& decomposition, int index,
                   int depth) {
  const Zones zones = find_zones(CellGrid(problem), decomposition, index, depth);
  PartSize size;
  size.own_elements = zones.own.cell_count();
  int last_row = -1;
  for (const Segment& segment : zones.own.segments()) {
    size.own_rows += segment.row != last_row;
    last_row = segment.row;
  }
  for (const CellSet& layer : zones.layers) size.layer_elements.push_back(layer.cell_count());
  const int first = zones.own.segments().front().row;
  for (const Zones::Face& face : zones.faces) {
    const auto& received = face.receive.segments();
    const Side side = received.empty()                  ? Side::among
                      : received.back().row < first     ? Side::lower
                      : received.front().row > last_row ? Side::upper
                                                        : Side::among;
    size.faces.push_back({face.part, side, face.send.cell_count(), face.receive.cell_count()});
  }
  measure_rows(problem.lattice, zones, size);
  return size;
}

} // namespace dss
