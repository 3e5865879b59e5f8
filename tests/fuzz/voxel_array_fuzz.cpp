/// Arrays of voxels: image data of VTK, arrays of NumPy, plain numbers.
#include "fuzzed.hpp"
#include "solver/io/voxels/npy.hpp"
#include "solver/io/voxels/voxel_numbers.hpp"
#include "solver/io/voxels/vti.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto answered = [&](auto&& read) { dss::answered_for_file(data, size, ".bin", read); };
  constexpr long most = 100000;
  answered([](const std::string& path) { dss::read_vti_voxels(path, "", most); });
  answered([](const std::string& path) { dss::read_npy_voxels(path, most); });
  answered([](const std::string& path) {
    dss::read_raw_voxels(path, {2, 2, 2}, dss::number_types()[1], most);
  });
  return 0;
}
