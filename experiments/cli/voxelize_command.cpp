#include "experiments/base/text_table.hpp"
#include "experiments/cli/arguments.hpp"
#include "experiments/cli/command_files.hpp"
#include "experiments/cli/commands.hpp"
#include "solver/error.hpp"
#include "solver/io/file_set.hpp"
#include "solver/io/picture/picture.hpp"
#include "solver/io/voxels/npy.hpp"
#include "solver/io/voxels/vti.hpp"
#include "solver/scene/geometry.hpp"
#include "solver/surface/shape_report.hpp"
#include "solver/surface/stl.hpp"
#include "solver/surface/voxelize.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>

namespace dss {
namespace {

struct VoxelizeArguments {
  std::string file, unit, rule = "closed", output, picture, json;
  std::vector<std::string> axes;
  std::vector<double> cell;
  long count = 0;
};

Eigen::Vector3d edge_of(const VoxelizeArguments& arguments, const Surface& surface) {
  if (arguments.cell.empty() == (arguments.count == 0))
    throw InputError("voxelize: give either --cell [m] or --count, so many along the longest side");
  if (arguments.count != 0) {
    if (arguments.count < 1 || arguments.count > max_elements)
      throw InputError(fmt::format("--count {}: take 1 to {}", arguments.count, max_elements));
    return Eigen::Vector3d::Constant(edge_for(surface, arguments.count));
  }
  const std::vector<double>& cell = arguments.cell;
  if (cell.size() != 1 && cell.size() != 3)
    throw InputError(fmt::format("--cell {}: give one length, or three along x, y, z [m]",
                                 fmt::join(cell, ",")));
  for (const double edge : cell)
    if (!(edge > 0) || !std::isfinite(edge))
      throw InputError(fmt::format("--cell {}: a length is positive", fmt::join(cell, ",")));
  return {cell.front(), cell[cell.size() / 2], cell.back()};
}

PictureFace face_of(const OuterFace& face, const Row& row, int x, const SpaceGrid& grid) {
  PictureFace drawn;
  const Eigen::Vector3d cell(x, row.y, row.z);
  for (std::size_t n = 0; n < 4; ++n) {
    const Eigen::Vector3d corner(double(face.corners[n] & 1), double(face.corners[n] >> 1 & 1),
                                 double(face.corners[n] >> 2 & 1));
    drawn.corners[n] = (cell + corner).cwiseProduct(grid.edge).cast<float>();
  }
  return drawn;
}

std::string picture_of(const std::string& title, const SpaceGrid& grid, const VoxelGrid& voxels) {
  Lattice lattice;
  append_body(lattice, voxels, 0);
  const std::vector<OuterFace> outer = outer_faces(lattice);
  std::vector<PictureFace> faces;
  faces.reserve(outer.size());
  auto next = outer.begin();
  lattice.for_each_element([&](std::size_t element, const Row& row, int x) {
    for (; next != outer.end() && next->element == element; ++next)
      faces.push_back(face_of(*next, row, x, grid));
  });
  return picture_svg(faces, {title, std::nullopt});
}

void write_voxels(AtomicFile& file, const SpaceGrid& grid, const VoxelGrid& voxels) {
  if (file.target().ends_with(".npy")) return write_npy_voxels(file, voxels);
  ImageVoxels image{voxels, {}, {}};
  for (std::size_t a = 0; a < 3; ++a) {
    image.spacing[a] = grid.edge[Eigen::Index(a)];
    image.origin[a] = grid.low[Eigen::Index(a)];
  }
  write_vti_voxels(file, image);
}

nlohmann::ordered_json as_json(const VoxelizeArguments& arguments, const Surface& surface,
                               const SpaceGrid& grid, const ShapeReport& report) {
  const auto vector = [](const Eigen::Vector3d& v) { return Vec3{v[0], v[1], v[2]}; };
  const auto if_known = [](double value) {
    return std::isnan(value) ? nlohmann::ordered_json() : nlohmann::ordered_json(value);
  };
  const auto [low, high] = bounds(surface);
  nlohmann::ordered_json wall;
  if (report.thinnest)
    wall = {{"thickness_m", report.thinnest->thickness},
            {"elements", report.thinnest->elements},
            {"at_m", vector(report.thinnest->place)}};
  return {{"file", arguments.file},
          {"triangles", surface.triangles.size()},
          {"cell_m", vector(grid.edge)},
          {"origin_m", vector(grid.low)},
          {"cells", grid.count},
          {"elements", report.elements},
          {"surface_m", vector(high - low)},
          {"surface_volume_m3", if_known(report.surface_volume)},
          {"voxel_volume_m3", report.voxel_volume},
          {"volume_error", if_known(report.volume_error())},
          {"thinnest_wall", wall},
          {"pieces", report.pieces}};
}

void print(const VoxelizeArguments& arguments, const Surface& surface, const SpaceGrid& grid,
           const ShapeReport& report) {
  fmt::print("{}: {} triangles, {} x {} x {} cells of {:.4g} x {:.4g} x {:.4g} m, {} elements\n",
             arguments.file, surface.triangles.size(), grid.count[0], grid.count[1], grid.count[2],
             grid.edge[0], grid.edge[1], grid.edge[2], report.elements);
  const auto [low, high] = bounds(surface);
  fmt::print("the surface measures {:.4g} x {:.4g} x {:.4g} m\n", high[0] - low[0],
             high[1] - low[1], high[2] - low[2]);
  fmt::print("low corner of cell (0, 0, 0): [{:.6g}, {:.6g}, {:.6g}] m\n", grid.low[0], grid.low[1],
             grid.low[2]);
  if (std::isnan(report.surface_volume))
    fmt::print("volume: {:.6g} m^3; the surface is open, so it has none\n", report.voxel_volume);
  else
    fmt::print("volume: {:.6g} m^3, that of the surface is {:.6g} m^3 ({:+.3g} %)\n",
               report.voxel_volume, report.surface_volume, 100 * report.volume_error());
  if (report.thinnest)
    fmt::print("thinnest wall: {:.4g} m at [{:.4g}, {:.4g}, {:.4g}] m, {:.2g} elements\n",
               report.thinnest->thickness, report.thinnest->place[0], report.thinnest->place[1],
               report.thinnest->place[2], report.thinnest->elements);
  if (report.pieces.size() > 1)
    fmt::print("warning: {} pieces that nothing joins, of {} elements{}\n", report.pieces.size(),
               fmt::join(report.pieces.begin(),
                         report.pieces.begin() +
                             std::ptrdiff_t(std::min<std::size_t>(report.pieces.size(), 8)),
                         ", "),
               report.pieces.size() > 8 ? ", ..." : "");
}

void require_sound(const VoxelizeArguments& arguments) {
  const std::string& output = arguments.output;
  if (!output.empty() && !output.ends_with(".npy") && !output.ends_with(".vti"))
    throw InputError(fmt::format("--output {}: give a name that ends in .npy or .vti", output));
  if (!arguments.picture.empty() && !arguments.picture.ends_with(".svg"))
    throw InputError(fmt::format("--picture {}: give a name that ends in .svg", arguments.picture));
  CommandFiles files;
  files.read("FILE", arguments.file);
  files.write("--output", output);
  files.write("--picture", arguments.picture);
  files.write("--json", arguments.json);
  files.require_distinct();
  for (const std::string& target : {output, arguments.picture, arguments.json})
    if (!target.empty() && target != "-") require_writable(target);
}

int voxelize(const VoxelizeArguments& arguments) {
  require_sound(arguments);
  SurfacePlacement placement;
  placement.unit = length_of_unit(arguments.unit);
  if (!arguments.axes.empty()) placement.set_axes(arguments.axes);
  const SurfaceRule rule = surface_rule(arguments.rule);
  const Surface surface = read_stl(arguments.file, placement);
  const SpaceGrid grid = grid_around(surface, edge_of(arguments, surface), max_elements);
  const VoxelGrid voxels = filled(surface, grid, rule);
  const ShapeReport report = report_shape(surface, grid, voxels);
  FileSet outputs;
  const auto write = [&](const std::string& path, auto&& write_into) {
    if (path.empty()) return;
    AtomicFile& file = outputs.open(path);
    write_into(file);
    file.finish();
  };
  write(arguments.output, [&](AtomicFile& file) { write_voxels(file, grid, voxels); });
  write(arguments.picture, [&](AtomicFile& file) {
    file.write(
        picture_of(fmt::format("{}: {} elements", arguments.file, report.elements), grid, voxels));
  });
  write_json(outputs, arguments.json, as_json(arguments, surface, grid, report));
  outputs.commit();
  if (arguments.json != "-") {
    print(arguments, surface, grid, report);
    for (const std::string& path : {arguments.output, arguments.picture})
      if (!path.empty()) fmt::print("wrote {}\n", path);
  }
  return exit_success;
}

} // namespace

void add_voxelize_command(CLI::App& app, Chosen& chosen) {
  CLI::App* command =
      app.add_subcommand("voxelize", "Turn a surface (STL) into the elements of a body");
  const auto arguments = std::make_shared<VoxelizeArguments>();
  command->add_option("FILE", arguments->file, "STL file, binary or ASCII")->required();
  command->add_option("--unit", arguments->unit, "Unit of its numbers: m, cm, mm, um or in")
      ->required();
  command->add_option("--cell", arguments->cell, "Edge of an element [m]; or three as X,Y,Z")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("--count", arguments->count,
                      "In place of --cell: cubes, so many along the longest side");
  command
      ->add_option("--axes", arguments->axes,
                   "Axes of the file that become x, y, z: +y,+z,+x (default: +x,+y,+z)")
      ->delimiter(',')
      ->allow_extra_args(false);
  command
      ->add_option("--surface", arguments->rule,
                   "closed: refuse a surface that is open or crosses itself; winding: fill by "
                   "winding numbers, which joins overlapping parts and closes holes")
      ->capture_default_str();
  command->add_option("-o,--output", arguments->output,
                      "F.npy (NumPy) or F.vti (VTK) for the elements; a scene reads both");
  command->add_option("--picture", arguments->picture, "F.svg: picture of the elements");
  command->add_option("--json", arguments->json,
                      "File for the report as JSON, or - for standard output");
  command->footer("Example: dssbench voxelize part.stl --unit mm --cell 2e-3 --output part.npy "
                  "--picture part.svg\n"
                  "An element is a cell whose centre lies inside the surface.");
  command->callback(
      [arguments, &chosen] { chosen = [arguments] { return voxelize(*arguments); }; });
}

} // namespace dss
