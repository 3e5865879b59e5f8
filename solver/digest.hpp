#pragma once
/// FNV-1a, 64 bits: digests that are the same on every machine.
#include <cstdint>
#include <fmt/format.h>
#include <string>
#include <string_view>

namespace dss {

/// A digest of words (or bytes), in their order.
class Digest {
public:
  void add(std::uint64_t word) { hash_ = (hash_ ^ word) * 0x100000001b3u; }
  std::uint64_t value() const { return hash_; }

private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

/// Digest of a text's bytes, 16 hexadecimal digits.
inline std::string text_digest(std::string_view text) {
  Digest digest;
  for (const char c : text) digest.add(static_cast<unsigned char>(c));
  return fmt::format("{:016x}", digest.value());
}

} // namespace dss
