#pragma once
/// Base64 (RFC 4648), for images inside of pictures.
#include <cstdint>
#include <string>
#include <string_view>

namespace dss {

/// Bytes as text.
inline std::string base64(std::string_view bytes) {
  static constexpr char alphabet[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t group = 0;
    for (std::size_t n = 0; n < 3; ++n)
      group = group << 8U | (at + n < bytes.size() ? std::uint8_t(bytes[at + n]) : 0U);
    const std::size_t digits = bytes.size() - at + 1; // that hold bytes
    for (std::size_t digit = 0; digit < 4; ++digit)
      text += digit < digits ? alphabet[group >> (18 - 6 * digit) & 63U] : '=';
  }
  return text;
}

} // namespace dss
