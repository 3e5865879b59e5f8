#pragma once
/// Base64 of a stream of bytes, for VTK's inline binary arrays.
#include "solver/io/atomic_file.hpp"

#include <cstdint>
#include <cstring>

namespace dss {

/// Encodes bytes into a file. finish() adds the padding.
class Base64Writer {
public:
  explicit Base64Writer(AtomicFile& file) : file_(file) {}

  template <class T>
  void put(const T& value) {
    unsigned char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    for (const unsigned char byte : bytes) {
      group_ = (group_ << 8) | byte;
      if (++held_ == 3) emit(4);
    }
  }

  void finish() {
    if (held_ > 0) {
      const int digits = held_ + 1;
      group_ <<= 8 * (3 - held_);
      emit(digits);
    }
    file_.write(text_);
    text_.clear();
  }

private:
  void emit(int digits) {
    static constexpr char alphabet[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (int digit = 0; digit < 4; ++digit)
      text_ += digit < digits ? alphabet[(group_ >> (18 - 6 * digit)) & 63u] : '=';
    group_ = 0;
    held_ = 0;
    if (text_.size() > 4096) {
      file_.write(text_);
      text_.clear();
    }
  }

  AtomicFile& file_;
  std::string text_;
  std::uint32_t group_ = 0;
  int held_ = 0;
};

} // namespace dss
