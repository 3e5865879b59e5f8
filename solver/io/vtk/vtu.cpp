#include "solver/io/vtk/vtu.hpp"

#include "solver/io/vtk/appended_data.hpp"
#include "solver/io/vtk/state_arrays.hpp"
#include "solver/io/xml_text.hpp"

#include <array>
#include <cstdint>
#include <fmt/format.h>
#include <string_view>
#include <tuple>
#include <type_traits>

namespace dss {
namespace {

constexpr std::string_view component_names =
    " ComponentName0=\"XX\" ComponentName1=\"YY\" ComponentName2=\"ZZ\" ComponentName3=\"XY\" "
    "ComponentName4=\"YZ\" ComponentName5=\"XZ\"";

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

void add_cells(Arrays& out, std::size_t count, const ElementNodes& nodes) {
  out.line("<Cells>\n");
  out.add<std::int64_t>("Int64", "connectivity", 1, 8 * count, [&](std::size_t n, std::size_t) {
    return std::int64_t(nodes.of(n / 8)[vtk_corners[n % 8]]);
  });
  out.add<std::int64_t>("Int64", "offsets", 1, count,
                        [](std::size_t cell, std::size_t) { return std::int64_t(8 * (cell + 1)); });
  out.add<std::uint8_t>("UInt8", "types", 1, count,
                        [](std::size_t, std::size_t) { return vtk_hexahedron; });
  out.line("</Cells>\n");
}

void add_data(Arrays& out, const Problem& problem, std::span<const double> state,
              const StressOutput& stress, const NodeMotion& motion) {
  const auto put = [&](std::string_view name, std::size_t count, auto&& value_of) {
    out.vectors(name, count, value_of);
  };
  out.line("<Points>\n");
  put("points", motion.rest.size(), [&](std::size_t node) { return motion.rest[node]; });
  out.line("</Points>\n<PointData Vectors=\"displacement\" Scalars=\"von_mises\">\n");
  each_point_array(stress, motion, put);
  out.line("</PointData>\n");
  add_cells(out, stress.elements.size(), stress.nodes);
  out.line("<CellData Scalars=\"von_mises\">\n");
  each_cell_array(state, stress.elements, put);
  const std::vector<std::int32_t> body = body_numbers(problem.lattice);
  out.add<std::int32_t>("Int32", "body", 1, body.size(),
                        [&](std::size_t cell, std::size_t) { return body[cell]; });
  if (!problem.materials.empty())
    out.add<std::uint8_t>("UInt8", "material", 1, body.size(),
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
  write_texts(file, "units", std::array<std::string, 1>{vtk_units});
  file.write("</FieldData>\n");
}

} // namespace

void write_vtu(AtomicFile& file, const Problem& problem, double time, std::span<const double> state,
               const StressOutput& stress) {
  const std::size_t count = problem.lattice.element_count;
  Arrays arrays;
  add_data(arrays, problem, state, stress, node_motion(problem, state, stress.nodes));
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
  AtomicFile file(path);
  file.write("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
             "byte_order=\"LittleEndian\">\n<Collection>\n");
  for (const Frame& frame : frames)
    file.write(fmt::format("<DataSet timestep=\"{:.17g}\" part=\"0\" file=\"{}\"/>\n", frame.time,
                           xml_text(frame.file)));
  file.write("</Collection>\n</VTKFile>\n");
  file.commit();
}

} // namespace dss
