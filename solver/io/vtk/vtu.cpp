#include "solver/io/vtk/vtu.hpp"

#include "solver/io/vtk/appended_data.hpp"
#include "solver/io/vtk/node_motion.hpp"

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

/// Rotation vector [rad] of the stored quaternion, with an angle in [0, pi].
Vec3 rotation_vector(const double* fields) {
  const double sign = 1 + fields[qs] < 0 ? -1 : 1;
  const Vec3 r = {sign * fields[qx], sign * fields[qy], sign * fields[qz]};
  const double sine = std::hypot(r[0], r[1], r[2]), cosine = sign * (1 + fields[qs]);
  const double scale = sine > 0 ? 2 * std::atan2(sine, cosine) / sine : 2;
  return {scale * r[0], scale * r[1], scale * r[2]};
}

/// The XML of a file's arrays, and their numbers.
class Arrays {
public:
  void line(std::string_view text) { xml_ += text; }
  /// @param of  what it gives at n < count, components of it
  template <class T, class Of>
  void add(std::string_view type, std::string_view name, std::size_t components, std::size_t count,
           Of&& of) {
    std::vector<T> numbers;
    numbers.reserve(components * count);
    for (std::size_t n = 0; n < count; ++n)
      for (std::size_t c = 0; c < components; ++c) numbers.push_back(of(n, c));
    xml_ += fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"{} "
        "format=\"appended\" offset=\"{}\"/>\n",
        type, name, components, components == 6 ? component_names : "",
        data_.add({reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T)}));
  }
  /// An array of vectors, or of scalars as vectors of length 1. @param value_of  of the n-th
  template <class ValueOf>
  void vectors(std::string_view name, std::size_t count, ValueOf&& value_of) {
    constexpr std::size_t components =
        std::tuple_size_v<std::decay_t<decltype(value_of(std::size_t(0)))>>;
    add<double>("Float64", name, components, count,
                [&](std::size_t n, std::size_t c) { return double(value_of(n)[c]); });
  }
  const std::string& xml() const { return xml_; }
  const AppendedData& data() const { return data_; }

private:
  std::string xml_;
  AppendedData data_;
};

SymmetricTensor in_vtk_order(const SymmetricTensor& tensor) {
  SymmetricTensor ordered;
  for (std::size_t c = 0; c < ordered.size(); ++c) ordered[c] = tensor[vtk_components[c]];
  return ordered;
}

void add_points(Arrays& out, const Problem& problem, std::span<const double> state,
                const StressOutput& stress) {
  const NodeMotion motion = node_motion(problem, state, stress.nodes);
  const std::size_t count = stress.nodes.count();
  out.line("<Points>\n");
  out.vectors("points", count, [&](std::size_t node) { return motion.rest[node]; });
  out.line("</Points>\n<PointData Vectors=\"displacement\" Scalars=\"von_mises\">\n");
  out.vectors("displacement", count, [&](std::size_t node) { return motion.displacement[node]; });
  out.vectors("stress", count,
              [&](std::size_t node) { return in_vtk_order(stress.at_nodes[node]); });
  out.vectors("von_mises", count,
              [&](std::size_t node) { return std::array{von_mises(stress.at_nodes[node])}; });
  out.line("</PointData>\n");
}

void add_cells(Arrays& out, std::size_t count, const ElementNodes& nodes) {
  out.line("<Cells>\n");
  out.add<std::int64_t>("Int64", "connectivity", 8, count, [&](std::size_t cell, std::size_t n) {
    return std::int64_t(nodes.of(cell)[corners[n]]);
  });
  out.add<std::int64_t>("Int64", "offsets", 1, count,
                        [](std::size_t cell, std::size_t) { return std::int64_t(8 * (cell + 1)); });
  out.add<std::uint8_t>("UInt8", "types", 1, count,
                        [](std::size_t, std::size_t) { return vtk_hexahedron; });
  out.line("</Cells>\n");
}

void add_cell_data(Arrays& out, const Problem& problem, std::span<const double> state,
                   std::span<const ElementStress> stress) {
  const auto of_cells = [&](std::string_view name, auto&& value_of) {
    out.vectors(name, stress.size(), value_of);
  };
  const auto at = [&](int first) {
    return [&state, first](std::size_t cell) {
      const double* f = &state[cell * field_count + std::size_t(first)];
      return Vec3{f[0], f[1], f[2]};
    };
  };
  out.line("<CellData Scalars=\"von_mises\">\n");
  of_cells("displacement", at(ux));
  of_cells("velocity", at(vx));
  of_cells("rotation_vector",
           [&](std::size_t cell) { return rotation_vector(&state[cell * field_count]); });
  of_cells("stress", [&](std::size_t cell) { return in_vtk_order(stress[cell].stress); });
  of_cells("von_mises",
           [&](std::size_t cell) { return std::array{von_mises(stress[cell].stress)}; });
  of_cells("principal_stress",
           [&](std::size_t cell) { return principal_values(stress[cell].stress); });
  of_cells("strain", [&](std::size_t cell) { return in_vtk_order(stress[cell].strain); });
  std::vector<std::int32_t> body(stress.size());
  problem.lattice.for_each_element(
      [&](std::size_t e, const Row& row, int) { body[e] = std::int32_t(row.body); });
  out.add<std::int32_t>("Int32", "body", 1, stress.size(),
                        [&](std::size_t cell, std::size_t) { return body[cell]; });
  if (!problem.materials.empty())
    out.add<std::uint8_t>("UInt8", "material", 1, stress.size(),
                          [&](std::size_t cell, std::size_t) { return problem.materials[cell]; });
  out.line("</CellData>\n");
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
  Arrays arrays;
  add_points(arrays, problem, state, stress);
  add_cells(arrays, count, stress.nodes);
  add_cell_data(arrays, problem, state, stress.elements);
  file.write("<?xml version=\"1.0\"?>\n"
             "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
             "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n");
  write_field_data(file, problem, time);
  file.write(fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
                         stress.nodes.count(), count));
  file.write(arrays.xml());
  file.write("</Piece>\n</UnstructuredGrid>\n");
  arrays.data().write(file);
  file.write("</VTKFile>\n");
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
