#include "solver/io/block_file.hpp"

#include "solver/digest.hpp"
#include "solver/error.hpp"

#include <bit>
#include <filesystem>
#include <fmt/format.h>

namespace dss {
namespace {

static_assert(std::endian::native == std::endian::little, "block files are little-endian");

constexpr const char* first_line = "dssbench blocks 1";
constexpr std::uint64_t word_bytes = 8;

std::uint64_t block_digest(std::uint64_t number, std::span<const double> numbers) {
  Digest digest;
  digest.add(number);
  digest.add(numbers.size());
  for (const double value : numbers) digest.add(std::bit_cast<std::uint64_t>(value));
  return digest.value();
}

std::string_view bytes_of(const std::uint64_t& word) {
  return {reinterpret_cast<const char*>(&word), sizeof word};
}

} // namespace

BlockWriter::BlockWriter(std::string target, const nlohmann::ordered_json& head)
    : target_(std::move(target)), file_(target_) {
  const std::string text = head.dump();
  file_.write(fmt::format("{}\n{}\n{}\n", first_line, text, text_digest(text)));
}

void BlockWriter::write(std::span<const double> numbers) {
  const std::uint64_t count = numbers.size(), digest = block_digest(blocks_++, numbers);
  file_.write(bytes_of(count));
  file_.write({reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes()});
  file_.write(bytes_of(digest));
}

void BlockWriter::commit(const std::string& earlier) {
  write({});
  file_.finish();
  std::error_code error;
  if (!earlier.empty() && std::filesystem::is_regular_file(target_, error)) {
    // A second name first, so that the target never lacks a file.
    if (std::filesystem::is_regular_file(earlier, error)) std::filesystem::remove(earlier, error);
    std::filesystem::create_hard_link(target_, earlier, error);
    if (error) std::filesystem::rename(target_, earlier, error); // no hard links here
    if (error)
      throw InputError(
          fmt::format("{}: cannot keep it as {}: {}", target_, earlier, error.message()));
  }
  file_.commit();
}

BlockReader::BlockReader(std::string path) : path_(std::move(path)) {
  std::error_code error;
  size_ = std::filesystem::file_size(path_, error);
  if (error) throw InputError(fmt::format("{}: cannot read: {}", path_, error.message()));
  stream_.open(path_, std::ios::binary);
  std::string line, text, digest;
  if (!std::getline(stream_, line) || line != first_line)
    throw InputError(fmt::format("{}: not a checkpoint of this program: its first line is not "
                                 "\"{}\"",
                                 path_, first_line));
  if (!std::getline(stream_, text) || !std::getline(stream_, digest) || digest != text_digest(text))
    fail("its head is damaged");
  head_ = nlohmann::json::parse(text, nullptr, false);
  if (!head_.is_object()) fail("its head is no JSON object");
}

std::vector<double> BlockReader::read_block() {
  std::uint64_t count = 0, digest = 0;
  const auto read = [&](void* to, std::uint64_t bytes) {
    if (!stream_.read(static_cast<char*>(to), std::streamsize(bytes)))
      fail(fmt::format("it ends within block {}", blocks_));
  };
  read(&count, sizeof count);
  if (count > size_ / word_bytes) fail(fmt::format("block {} is damaged", blocks_));
  std::vector<double> numbers(count);
  read(numbers.data(), count * word_bytes);
  read(&digest, sizeof digest);
  if (digest != block_digest(blocks_, numbers)) fail(fmt::format("block {} is damaged", blocks_));
  ++blocks_;
  return numbers;
}

std::vector<double> BlockReader::next() {
  std::vector<double> numbers = read_block();
  if (numbers.empty()) fail(fmt::format("it has {} blocks, too few", blocks_ - 1));
  return numbers;
}

void BlockReader::require_end() {
  if (!read_block().empty()) fail("it has more blocks than its head says");
  if (stream_.peek() != std::ifstream::traits_type::eof()) fail("something follows its last block");
}

void BlockReader::fail(const std::string& what) const {
  throw InputError(fmt::format("{}: {}; take an earlier file", path_, what));
}

} // namespace dss
