#include "solver/io/vtu.hpp"
#include "solver/io/base64.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <string_view>

namespace dss {
namespace {

/// Corners of VTK_HEXAHEDRON in VTK's order, in half edges.
constexpr std::array<std::array<int, 3>, 8> corners = {{{-1, -1, -1},
                                                        {1, -1, -1},
                                                        {1, 1, -1},
                                                        {-1, 1, -1},
                                                        {-1, -1, 1},
                                                        {1, -1, 1},
                                                        {1, 1, 1},
                                                        {-1, 1, 1}}};
constexpr std::uint8_t vtk_hexahedron = 12;

Vec3 arm(const Problem& problem, const Row& row, const std::array<int, 3>& corner) {
  const Vec3& edge = problem.bodies[std::size_t(row.body)].edge;
  return {0.5 * edge[0] * corner[0], 0.5 * edge[1] * corner[1], 0.5 * edge[2] * corner[2]};
}

/// Displacement of the end of an arm c of a rigid element: u + (A - I) c, with
/// A - I = 2 q0 [r]x + 2 [r]x^2.
Vec3 corner_displacement(const double* fields, const Vec3& c) {
  const double w = 1 + fields[qs], x = fields[qx], y = fields[qy], z = fields[qz];
  const Vec3 t = {y * c[2] - z * c[1], z * c[0] - x * c[2], x * c[1] - y * c[0]};
  return {fields[ux] + 2 * (w * t[0] + y * t[2] - z * t[1]),
          fields[uy] + 2 * (w * t[1] + z * t[0] - x * t[2]),
          fields[uz] + 2 * (w * t[2] + x * t[1] - y * t[0])};
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
                std::size_t components, std::size_t count, std::string_view component_names,
                Fill&& fill) {
  file.write(fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"{} format=\"binary\">", type,
      name, components, component_names));
  Base64Writer out(file);
  out.put(std::uint64_t(components * count * sizeof(T)));
  fill(out);
  out.finish();
  file.write("</DataArray>\n");
}

void write_points(AtomicFile& file, const Problem& problem, std::span<const double> state) {
  const std::size_t count = 8 * problem.lattice.element_count;
  const auto each_corner = [&](auto&& visit) {
    problem.lattice.for_each_element([&](std::size_t element, const Row& row, int x) {
      const Vec3 centre = rest_position(problem, row, x);
      for (const auto& corner : corners) visit(element, centre, arm(problem, row, corner));
    });
  };
  file.write("<Points>\n");
  data_array<double>(file, "Float64", "points", 3, count, "", [&](Base64Writer& out) {
    each_corner([&](std::size_t, const Vec3& centre, const Vec3& c) {
      for (std::size_t axis = 0; axis < 3; ++axis) out.put(centre[axis] + c[axis]);
    });
  });
  file.write("</Points>\n<PointData Vectors=\"displacement\">\n");
  data_array<double>(file, "Float64", "displacement", 3, count, "", [&](Base64Writer& out) {
    each_corner([&](std::size_t element, const Vec3&, const Vec3& c) {
      for (const double value : corner_displacement(&state[element * field_count], c))
        out.put(value);
    });
  });
  file.write("</PointData>\n");
}

void write_cells(AtomicFile& file, std::size_t count) {
  file.write("<Cells>\n");
  data_array<std::int64_t>(file, "Int64", "connectivity", 1, 8 * count, "", [&](Base64Writer& out) {
    for (std::size_t point = 0; point < 8 * count; ++point) out.put(std::int64_t(point));
  });
  data_array<std::int64_t>(file, "Int64", "offsets", 1, count, "", [&](Base64Writer& out) {
    for (std::size_t cell = 1; cell <= count; ++cell) out.put(std::int64_t(8 * cell));
  });
  data_array<std::uint8_t>(file, "UInt8", "types", 1, count, "", [&](Base64Writer& out) {
    for (std::size_t cell = 0; cell < count; ++cell) out.put(vtk_hexahedron);
  });
  file.write("</Cells>\n");
}

void write_cell_data(AtomicFile& file, std::span<const double> state,
                     std::span<const ElementStress> stress) {
  const std::size_t count = stress.size();
  const auto vectors = [&](std::string_view name, auto&& vector_of) {
    data_array<double>(file, "Float64", name, 3, count, "", [&](Base64Writer& out) {
      for (std::size_t element = 0; element < count; ++element)
        for (const double value : vector_of(&state[element * field_count])) out.put(value);
    });
  };
  file.write("<CellData Scalars=\"von_mises\">\n");
  vectors("displacement", [](const double* f) { return Vec3{f[ux], f[uy], f[uz]}; });
  vectors("velocity", [](const double* f) { return Vec3{f[vx], f[vy], f[vz]}; });
  vectors("rotation_vector", rotation_vector);
  data_array<double>(
      file, "Float64", "stress", 6, count,
      " ComponentName0=\"XX\" ComponentName1=\"YY\" ComponentName2=\"ZZ\" ComponentName3=\"XY\" "
      "ComponentName4=\"YZ\" ComponentName5=\"XZ\"", // VTK's order of symmetric tensors
      [&](Base64Writer& out) {
        for (const ElementStress& s : stress)
          for (const std::size_t component : {0, 1, 2, 5, 3, 4}) out.put(s[component]);
      });
  data_array<double>(file, "Float64", "von_mises", 1, count, "", [&](Base64Writer& out) {
    for (const ElementStress& s : stress) out.put(s[6]);
  });
  file.write("</CellData>\n");
}

} // namespace

void write_vtu(AtomicFile& file, const Problem& problem, std::span<const double> state,
               std::span<const ElementStress> stress) {
  const std::size_t count = problem.lattice.element_count;
  file.write("<?xml version=\"1.0\"?>\n"
             "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
             "header_type=\"UInt64\">\n");
  file.write(fmt::format("<UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
                         8 * count, count));
  write_points(file, problem, state);
  write_cells(file, count);
  write_cell_data(file, state, stress);
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
