#pragma once
/// Files of numbers in which damage shows: a JSON head and blocks of numbers, each with a digest.
///
///     line 1    dssbench blocks 1
///     line 2    the head, JSON without line breaks
///     line 3    its digest, 16 hexadecimal digits
///     blocks    count (64 bits), `count` numbers (IEEE 754, 64 bits), digest (64 bits)
///     the end   a block of no numbers
///
/// All in little-endian order. A digest is FNV-1a over 64-bit words (of the head: over bytes). That
/// of a block begins with its number and its count, so that no block takes another's place.
#include "solver/io/atomic_file.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <fstream>
#include <span>
#include <string>
#include <vector>

namespace dss {

/// Writes a file of blocks. It appears whole or not at all.
class BlockWriter {
public:
  /// @throws InputError if the file cannot be created
  BlockWriter(std::string target, const nlohmann::ordered_json& head);
  /// Appends one block of at least one number. @throws InputError if it cannot be written
  void write(std::span<const double> numbers);
  /// Ends the file and moves it to its target.
  /// @param earlier  where a file that stands there goes; empty: it is replaced
  /// @throws InputError as write
  void commit(const std::string& earlier = {});

private:
  std::string target_;
  AtomicFile file_;
  std::uint64_t blocks_ = 0;
};

/// Reads such a file block by block.
class BlockReader {
public:
  /// @throws InputError if the file cannot be read, is no such file or its head is damaged
  explicit BlockReader(std::string path);
  const nlohmann::json& head() const { return head_; }
  /// The next block. @throws InputError with the block's number if it is damaged, or missing
  std::vector<double> next();
  /// @throws InputError if the file does not end here
  void require_end();

private:
  std::vector<double> read_block();
  [[noreturn]] void fail(const std::string& what) const;

  std::string path_;
  std::ifstream stream_;
  std::uint64_t size_ = 0, blocks_ = 0; ///< bytes of the file; blocks that were read
  nlohmann::json head_;
};

} // namespace dss
