#include "solver/io/vtk/vtkhdf.hpp"

#include "solver/error.hpp"
#include "solver/io/temporaries.hpp"
#include "solver/io/vtk/state_arrays.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <hdf5.h>
#include <tuple>
#include <type_traits>
#include <unistd.h>
#include <utility>

namespace dss {
namespace {

static_assert(sizeof(hid_t) == sizeof(std::int64_t));

/// An object of HDF5, which its close function ends.
class Owned {
public:
  Owned(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {
    if (id < 0) throw std::pair<const char*, int>{"cannot be written as HDF5", errno};
  }
  Owned(Owned&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
  ~Owned() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }

private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void require(herr_t status) {
  if (status < 0) throw std::pair<const char*, int>{"cannot be written as HDF5", errno};
}

template <class T>
hid_t type_of() {
  if constexpr (std::is_same_v<T, double>) return H5T_NATIVE_DOUBLE;
  if constexpr (std::is_same_v<T, std::uint8_t>) return H5T_NATIVE_UINT8;
  if constexpr (std::is_same_v<T, std::int32_t>) return H5T_NATIVE_INT32;
  return H5T_NATIVE_INT64;
}

/// HDF5 prints errors of its own, unless each thread says otherwise.
void tell_errors_in_one_line() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

constexpr hsize_t most_chunk_rows = 32768;

/// How arrays are stored: in chunks, compressed. Bytes of equal weight stand together, which makes
/// numbers of one size smaller.
/// @param rows  of a state: a chunk has those of one, so that a later state changes none before
Owned storage(hsize_t components, hsize_t rows) {
  Owned list(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  const hsize_t chunk[2] = {std::clamp<hsize_t>(rows, 1, most_chunk_rows), components};
  require(H5Pset_chunk(list, components > 1 ? 2 : 1, chunk));
  require(H5Pset_shuffle(list));
  require(H5Pset_deflate(list, 1));
  return list;
}

/// Appends rows of numbers to an array, which is made by the first ones.
template <class T>
void append_rows(hid_t file, const std::string& name, hsize_t components,
                 const std::vector<T>& numbers) {
  const int rank = components > 1 ? 2 : 1;
  const hsize_t rows = numbers.size() / components;
  hsize_t size[2] = {0, components};
  if (H5Lexists(file, name.c_str(), H5P_DEFAULT) <= 0) {
    const hsize_t most[2] = {H5S_UNLIMITED, components};
    const Owned space(H5Screate_simple(rank, size, most), H5Sclose);
    const Owned list = storage(components, rows);
    const Owned made(
        H5Dcreate2(file, name.c_str(), type_of<T>(), space, H5P_DEFAULT, list, H5P_DEFAULT),
        H5Dclose);
  }
  const Owned set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  {
    const Owned space(H5Dget_space(set), H5Sclose);
    require(H5Sget_simple_extent_dims(space, size, nullptr));
  }
  const hsize_t start[2] = {size[0], 0}, count[2] = {rows, components};
  size[0] += rows;
  require(H5Dset_extent(set, size));
  const Owned space(H5Dget_space(set), H5Sclose);
  require(H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, count, nullptr));
  const Owned memory(H5Screate_simple(rank, count, nullptr), H5Sclose);
  require(H5Dwrite(set, type_of<T>(), memory, space, H5P_DEFAULT, numbers.data()));
}

void make_group(hid_t file, const std::string& name) {
  const Owned group(H5Gcreate2(file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                    H5Gclose);
}

void set_text(hid_t file, const char* group, const char* name, const std::string& text) {
  const Owned of(H5Gopen2(file, group, H5P_DEFAULT), H5Gclose);
  const Owned type(H5Tcopy(H5T_C_S1), H5Tclose);
  require(H5Tset_size(type, text.size()));
  require(H5Tset_strpad(type, H5T_STR_NULLPAD));
  const Owned space(H5Screate(H5S_SCALAR), H5Sclose);
  const Owned made(H5Acreate2(of, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  require(H5Awrite(made, type, text.data()));
}

void set_numbers(hid_t file, const char* group, const char* name,
                 const std::vector<std::int64_t>& numbers) {
  const Owned of(H5Gopen2(file, group, H5P_DEFAULT), H5Gclose);
  const hsize_t size = numbers.size();
  const Owned space(size == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &size, nullptr),
                    H5Sclose);
  const Owned made(H5Acreate2(of, name, H5T_NATIVE_INT64, space, H5P_DEFAULT, H5P_DEFAULT),
                   H5Aclose);
  require(H5Awrite(made, H5T_NATIVE_INT64, numbers.data()));
}

void write_texts(hid_t file, const std::string& name, const std::vector<std::string>& texts) {
  const Owned type(H5Tcopy(H5T_C_S1), H5Tclose);
  require(H5Tset_size(type, H5T_VARIABLE));
  const hsize_t size = texts.size();
  const Owned space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  const Owned made(
      H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
  std::vector<const char*> characters;
  for (const std::string& text : texts) characters.push_back(text.c_str());
  require(H5Dwrite(made, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, characters.data()));
}

std::string made_beside(const std::string& target) {
  std::string pattern = target + ".XXXXXX.part";
  const int descriptor = make_temporary(pattern, 0666);
  if (descriptor < 0)
    throw InputError(fmt::format("{}: cannot be created: {}", target, std::strerror(errno)));
  ::close(descriptor);
  return pattern;
}

} // namespace

void VtkHdfFile::fail(const char* what) const {
  throw InputError(fmt::format("{}: {}{}{}", target_, what, errno != 0 ? ": " : "",
                               errno != 0 ? std::strerror(errno) : ""));
}

VtkHdfFile::VtkHdfFile(std::string target)
    : target_(std::move(target)), temporary_(made_beside(target_)) {
  tell_errors_in_one_line();
  file_ = H5Fcreate(temporary_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  if (file_ < 0) {
    ::unlink(temporary_.c_str());
    forget_temporary(temporary_);
    fail("cannot be created as HDF5");
  }
}

VtkHdfFile::~VtkHdfFile() {
  if (file_ >= 0) H5Fclose(file_);
  if (temporary_.empty()) return;
  ::unlink(temporary_.c_str());
  forget_temporary(temporary_);
}

void VtkHdfFile::write_bodies(const Problem& problem, const StressOutput& stress) {
  for (const char* group : {"VTKHDF", "VTKHDF/PointData", "VTKHDF/CellData", "VTKHDF/FieldData"})
    make_group(file_, group);
  set_numbers(file_, "VTKHDF", "Version", {2, 0});
  set_text(file_, "VTKHDF", "Type", "UnstructuredGrid");
  points_ = stress.at_nodes.size(), cells_ = stress.elements.size();
  std::vector<std::int64_t> connectivity, offsets{0};
  for (std::size_t cell = 0; cell < cells_; ++cell) {
    for (const std::size_t corner : vtk_corners)
      connectivity.push_back(std::int64_t(stress.nodes.of(cell)[corner]));
    offsets.push_back(std::int64_t(connectivity.size()));
  }
  const auto put_count = [&](const char* name, std::size_t count) {
    append_rows<std::int64_t>(file_, fmt::format("VTKHDF/{}", name), 1, {std::int64_t(count)});
  };
  put_count("NumberOfPoints", points_);
  put_count("NumberOfCells", cells_);
  put_count("NumberOfConnectivityIds", connectivity.size());
  append_rows(file_, "VTKHDF/Connectivity", 1, connectivity);
  append_rows(file_, "VTKHDF/Offsets", 1, offsets);
  append_rows(file_, "VTKHDF/Types", 1, std::vector<std::uint8_t>(cells_, vtk_hexahedron));
  append_rows(file_, "VTKHDF/CellData/body", 1, body_numbers(problem.lattice));
  if (!problem.materials.empty())
    append_rows(file_, "VTKHDF/CellData/material", 1, problem.materials);
  std::vector<std::string> bodies;
  for (const Body& body : problem.bodies) bodies.push_back(body.name);
  bodies_ = bodies.size();
  write_texts(file_, "VTKHDF/FieldData/scene", {problem.name});
  write_texts(file_, "VTKHDF/FieldData/bodies", bodies);
  write_texts(file_, "VTKHDF/FieldData/units", {vtk_units});
}

void VtkHdfFile::add(const Problem& problem, double time, std::span<const double> state,
                     const StressOutput& stress) {
  const NodeMotion motion = node_motion(problem, state, stress.nodes);
  const auto put = [&](const std::string& name, std::size_t count, auto&& value_of) {
    constexpr std::size_t components =
        std::tuple_size_v<std::decay_t<decltype(value_of(std::size_t(0)))>>;
    std::vector<double> numbers;
    numbers.reserve(components * count);
    for (std::size_t n = 0; n < count; ++n)
      for (const double number : value_of(n)) numbers.push_back(number);
    append_rows(file_, name, components, numbers);
  };
  const auto put_in = [&](const char* group, std::vector<std::string>& names) {
    return [&, group](std::string_view name, std::size_t count, auto&& value_of) {
      if (times_.empty()) names.emplace_back(name);
      put(fmt::format("VTKHDF/{}/{}", group, name), count, value_of);
    };
  };
  errno = 0;
  try {
    tell_errors_in_one_line();
    if (times_.empty()) {
      write_bodies(problem, stress);
      put("VTKHDF/Points", points_, [&](std::size_t node) { return motion.rest[node]; });
    }
    each_point_array(stress, motion, put_in("PointData", point_arrays_));
    each_cell_array(state, stress.elements, put_in("CellData", cell_arrays_));
    times_.push_back(time);
    require(H5Fflush(file_, H5F_SCOPE_GLOBAL));
  } catch (const std::pair<const char*, int>& fault) {
    errno = fault.second;
    fail(fault.first);
  }
}

/// Where each state begins. The bodies are the same for all.
void VtkHdfFile::write_steps() {
  const std::size_t count = times_.size();
  make_group(file_, "VTKHDF/Steps");
  set_numbers(file_, "VTKHDF/Steps", "NSteps", {std::int64_t(count)});
  append_rows(file_, "VTKHDF/Steps/Values", 1, times_);
  const std::vector<std::int64_t> zeros(count, 0);
  for (const char* name : {"PartOffsets", "PointOffsets", "CellOffsets", "ConnectivityIdOffsets"})
    append_rows(file_, fmt::format("VTKHDF/Steps/{}", name), 1, zeros);
  append_rows(file_, "VTKHDF/Steps/NumberOfParts", 1, std::vector<std::int64_t>(count, 1));
  const auto put_offsets = [&](const char* group, const std::vector<std::string>& names,
                               std::size_t rows) {
    make_group(file_, fmt::format("VTKHDF/Steps/{}", group));
    std::vector<std::int64_t> offsets;
    for (std::size_t n = 0; n < count; ++n) offsets.push_back(std::int64_t(n * rows));
    for (const std::string& name : names)
      append_rows(file_, fmt::format("VTKHDF/Steps/{}/{}", group, name), 1, offsets);
  };
  put_offsets("PointDataOffsets", point_arrays_, points_);
  put_offsets("CellDataOffsets", cell_arrays_, cells_);
  append_rows(file_, "VTKHDF/Steps/CellDataOffsets/body", 1, zeros);
  if (H5Lexists(file_, "VTKHDF/CellData/material", H5P_DEFAULT) > 0)
    append_rows(file_, "VTKHDF/Steps/CellDataOffsets/material", 1, zeros);
  make_group(file_, "VTKHDF/Steps/FieldDataOffsets");
  make_group(file_, "VTKHDF/Steps/FieldDataSizes");
  for (const auto& [name, texts] :
       {std::pair("scene", std::size_t(1)), {"bodies", bodies_}, {"units", std::size_t(1)}}) {
    append_rows(file_, fmt::format("VTKHDF/Steps/FieldDataOffsets/{}", name), 1, zeros);
    std::vector<std::int64_t> sizes; // components and texts
    for (std::size_t n = 0; n < count; ++n) sizes.insert(sizes.end(), {1, std::int64_t(texts)});
    append_rows(file_, fmt::format("VTKHDF/Steps/FieldDataSizes/{}", name), 2, sizes);
  }
}

void VtkHdfFile::copy_to(AtomicFile& file) {
  errno = 0;
  try {
    tell_errors_in_one_line();
    write_steps();
    require(H5Fclose(std::exchange(file_, -1)));
  } catch (const std::pair<const char*, int>& fault) {
    errno = fault.second;
    fail(fault.first);
  }
  std::ifstream whole(temporary_, std::ios::binary);
  std::vector<char> part(std::size_t(1) << 20U);
  while (whole.read(part.data(), std::streamsize(part.size())) || whole.gcount() > 0)
    file.write({part.data(), std::size_t(whole.gcount())});
  if (!whole.eof()) fail("cannot be read again");
}

} // namespace dss
