#include "solver/io/vtk/appended_data.hpp"

#include "solver/parallel.hpp"

#include <cstdint>
#include <stdexcept>
#include <zlib.h>

namespace dss {
namespace {

constexpr std::size_t block_bytes = std::size_t(1) << 18U;
/// The lowest level of zlib: numbers in double precision get hardly smaller with higher ones.
constexpr int level = 1;

std::string compressed(std::string_view bytes) {
  uLongf size = compressBound(bytes.size());
  std::string block(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(block.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), level) != Z_OK)
    throw std::runtime_error("appended_data.cpp: zlib has no memory");
  block.resize(size);
  return block;
}

std::vector<std::string> compressed_blocks(std::string_view bytes) {
  std::vector<std::string> blocks((bytes.size() + block_bytes - 1) / block_bytes);
  for_each_on_all_cores(blocks.size(), [&](std::size_t n) {
    blocks[n] = compressed(bytes.substr(n * block_bytes, block_bytes));
  });
  return blocks;
}

} // namespace

std::size_t AppendedData::add(std::string_view bytes) {
  const std::size_t offset = data_.size();
  const auto put = [&](std::uint64_t word) {
    data_.append(reinterpret_cast<const char*>(&word), sizeof word);
  };
  const std::vector<std::string> blocks = compressed_blocks(bytes);
  // Number of blocks, their size, the size of the last one if it is another, their compressed
  // sizes.
  put(blocks.size());
  put(block_bytes);
  put(bytes.size() % block_bytes);
  for (const std::string& block : blocks) put(block.size());
  for (const std::string& block : blocks) data_ += block;
  return offset;
}

void AppendedData::write(AtomicFile& file) const {
  file.write("<AppendedData encoding=\"raw\">\n_");
  file.write(data_);
  file.write("\n</AppendedData>\n");
}

} // namespace dss
