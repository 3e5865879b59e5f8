#include "solver/io/vtu.hpp"
#include "solver/io/base64.hpp"
#include "solver/model/element_place.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <string_view>
#include <tuple>
#include <type_traits>

namespace dss {
namespace {

/// Corners of VTK_HEXAHEDRON in VTK's order, as ElementNodes numbers them.
constexpr std::array<std::size_t, 8> corners = {0, 1, 3, 2, 4, 5, 7, 6};
constexpr std::uint8_t vtk_hexahedron = 12;
/// Components of a SymmetricTensor in VTK's order.
constexpr std::array<std::size_t, 6> vtk_components = {0, 1, 2, 5, 3, 4};
constexpr std::string_view component_names =
    " ComponentName0=\"XX\" ComponentName1=\"YY\" ComponentName2=\"ZZ\" ComponentName3=\"XY\" "
    "ComponentName4=\"YZ\" ComponentName5=\"XZ\"";

Vec3 arm(const Problem& problem, const Row& row, std::size_t corner) {
  Vec3 arm = problem.bodies[std::size_t(row.body)].edge;
  for (std::size_t a = 0; a < 3; ++a) arm[a] *= (corner >> a & 1) != 0 ? 0.5 : -0.5;
  return arm;
}

/// Rotation vector [rad] of the stored quaternion, with an angle in [0, pi].
Vec3 rotation_vector(const double* fields) {
  const double sign = 1 + fields[qs] < 0 ? -1 : 1;
  const Vec3 r = {sign * fields[qx], sign * fields[qy], sign * fields[qz]};
  const double sine = std::hypot(r[0], r[1], r[2]), cosine = sign * (1 + fields[qs]);
  const double scale = sine > 0 ? 2 * std::atan2(sine, cosine) / sine : 2;
  return {scale * r[0], scale * r[1], scale * r[2]};
}

/// Writes one <DataArray>: a 64-bit byte count, then the numbers from `fill`.
template <class T, class Fill>
void data_array(AtomicFile& file, std::string_view type, std::string_view name,
                std::size_t components, std::size_t count, Fill&& fill) {
  file.write(fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"{} format=\"binary\">", type,
      name, components, components == 6 ? component_names : ""));
  Base64Writer out(file);
  out.put(std::uint64_t(components * count * sizeof(T)));
  fill(out);
  out.finish();
  file.write("</DataArray>\n");
}

/// An array of vectors, or of scalars as vectors of length 1. @param value_of  of the n-th
template <class ValueOf>
void vectors(AtomicFile& file, std::string_view name, std::size_t count, ValueOf&& value_of) {
  const std::size_t components = std::tuple_size_v<std::decay_t<decltype(value_of(count))>>;
  data_array<double>(file, "Float64", name, components, count, [&](Base64Writer& out) {
    for (std::size_t n = 0; n < count; ++n)
      for (const double value : value_of(n)) out.put(value);
  });
}

SymmetricTensor in_vtk_order(const SymmetricTensor& tensor) {
  SymmetricTensor ordered;
  for (std::size_t c = 0; c < ordered.size(); ++c) ordered[c] = tensor[vtk_components[c]];
  return ordered;
}

/// Places at rest and displacements of the nodes [m].
struct NodeMotion {
  std::vector<Vec3> rest, displacement;
};
NodeMotion node_motion(const Problem& problem, std::span<const double> state,
                       const ElementNodes& nodes) {
  NodeMotion motion{std::vector<Vec3>(nodes.count()), std::vector<Vec3>(nodes.count())};
  std::vector<int> shares(nodes.count());
  problem.lattice.for_each_element([&](std::size_t element, const Row& row, int x) {
    const Vec3 centre = rest_position(problem, row, x);
    for (std::size_t corner = 0; corner < 8; ++corner) {
      const std::size_t node = nodes.of(element)[corner];
      const Vec3 c = arm(problem, row, corner),
                 moved = displacement_at(&state[element * field_count], c);
      for (std::size_t a = 0; a < 3; ++a) {
        motion.rest[node][a] = centre[a] + c[a];
        motion.displacement[node][a] += moved[a];
      }
      ++shares[node];
    }
  });
  for (std::size_t node = 0; node < shares.size(); ++node)
    for (double& component : motion.displacement[node]) component /= shares[node];
  return motion;
}

void write_points(AtomicFile& file, const Problem& problem, std::span<const double> state,
                  const StressOutput& stress) {
  const NodeMotion motion = node_motion(problem, state, stress.nodes);
  const std::size_t count = stress.nodes.count();
  file.write("<Points>\n");
  vectors(file, "points", count, [&](std::size_t node) { return motion.rest[node]; });
  file.write("</Points>\n<PointData Vectors=\"displacement\" Scalars=\"von_mises\">\n");
  vectors(file, "displacement", count, [&](std::size_t node) { return motion.displacement[node]; });
  vectors(file, "stress", count,
          [&](std::size_t node) { return in_vtk_order(stress.at_nodes[node]); });
  vectors(file, "von_mises", count,
          [&](std::size_t node) { return std::array{von_mises(stress.at_nodes[node])}; });
  file.write("</PointData>\n");
}

void write_cells(AtomicFile& file, std::size_t count, const ElementNodes& nodes) {
  file.write("<Cells>\n");
  data_array<std::int64_t>(file, "Int64", "connectivity", 1, 8 * count, [&](Base64Writer& out) {
    for (std::size_t cell = 0; cell < count; ++cell)
      for (const std::size_t corner : corners) out.put(std::int64_t(nodes.of(cell)[corner]));
  });
  data_array<std::int64_t>(file, "Int64", "offsets", 1, count, [&](Base64Writer& out) {
    for (std::size_t cell = 1; cell <= count; ++cell) out.put(std::int64_t(8 * cell));
  });
  data_array<std::uint8_t>(file, "UInt8", "types", 1, count, [&](Base64Writer& out) {
    for (std::size_t cell = 0; cell < count; ++cell) out.put(vtk_hexahedron);
  });
  file.write("</Cells>\n");
}

void write_cell_data(AtomicFile& file, const Problem& problem, std::span<const double> state,
                     std::span<const ElementStress> stress) {
  const auto of_cells = [&](std::string_view name, auto&& value_of) {
    vectors(file, name, stress.size(), value_of);
  };
  const auto fields = [&](std::size_t cell) { return &state[cell * field_count]; };
  const auto at = [&](int first) {
    return [&state, first](std::size_t cell) {
      const double* f = &state[cell * field_count + std::size_t(first)];
      return Vec3{f[0], f[1], f[2]};
    };
  };
  file.write("<CellData Scalars=\"von_mises\">\n");
  of_cells("displacement", at(ux));
  of_cells("velocity", at(vx));
  of_cells("rotation_vector", [&](std::size_t cell) { return rotation_vector(fields(cell)); });
  of_cells("stress", [&](std::size_t cell) { return in_vtk_order(stress[cell].stress); });
  of_cells("von_mises",
           [&](std::size_t cell) { return std::array{von_mises(stress[cell].stress)}; });
  of_cells("principal_stress",
           [&](std::size_t cell) { return principal_values(stress[cell].stress); });
  of_cells("strain", [&](std::size_t cell) { return in_vtk_order(stress[cell].strain); });
  data_array<std::int32_t>(file, "Int32", "body", 1, stress.size(), [&](Base64Writer& out) {
    problem.lattice.for_each_element(
        [&](std::size_t, const Row& row, int) { out.put(std::int32_t(row.body)); });
  });
  file.write("</CellData>\n");
}

/// Texts are numbers of characters, each text with a 0 behind it.
void write_texts(AtomicFile& file, std::string_view name, std::span<const std::string> texts) {
  file.write(
      fmt::format("<DataArray type=\"String\" Name=\"{}\" NumberOfTuples=\"{}\" format=\"ascii\">",
                  name, texts.size()));
  for (const std::string& text : texts) {
    for (const char c : text) file.write(fmt::format("{} ", static_cast<unsigned char>(c)));
    file.write("0 ");
  }
  file.write("</DataArray>\n");
}

void write_field_data(AtomicFile& file, const Problem& problem, double time) {
  file.write("<UnstructuredGrid>\n<FieldData>\n");
  file.write(fmt::format("<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
                         "format=\"ascii\">{:.17g}</DataArray>\n",
                         time));
  std::vector<std::string> bodies;
  for (const Body& body : problem.bodies) bodies.push_back(body.name);
  write_texts(file, "scene", std::array{problem.name});
  write_texts(file, "bodies", bodies);
  write_texts(file, "units", std::array<std::string, 1>{"m, s, rad, Pa"});
  file.write("</FieldData>\n");
}

} // namespace

void write_vtu(AtomicFile& file, const Problem& problem, double time, std::span<const double> state,
               const StressOutput& stress) {
  const std::size_t count = problem.lattice.element_count;
  file.write("<?xml version=\"1.0\"?>\n"
             "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
             "header_type=\"UInt64\">\n");
  write_field_data(file, problem, time);
  file.write(fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
                         stress.nodes.count(), count));
  write_points(file, problem, state, stress);
  write_cells(file, count, stress.nodes);
  write_cell_data(file, problem, state, stress.elements);
  file.write("</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
}

void write_pvd(const std::string& path, std::span<const Frame> frames) {
  const auto escaped = [](std::string_view text) {
    std::string out;
    for (const char c : text) {
      if (c == '&')
        out += "&amp;";
      else if (c == '<')
        out += "&lt;";
      else if (c == '"')
        out += "&quot;";
      else
        out += c;
    }
    return out;
  };
  AtomicFile file(path);
  file.write("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
             "byte_order=\"LittleEndian\">\n<Collection>\n");
  for (const Frame& frame : frames)
    file.write(fmt::format("<DataSet timestep=\"{:.17g}\" part=\"0\" file=\"{}\"/>\n", frame.time,
                           escaped(frame.file)));
  file.write("</Collection>\n</VTKFile>\n");
  file.commit();
}

} // namespace dss
