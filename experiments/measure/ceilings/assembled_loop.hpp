#pragma once
/// Turns assembly text into machine code at run time. Needs `as` and `ld` (binutils).
#include <string>

namespace dss {

/// A function loop(in, out, count) with the System V calling convention, given by its body.
class AssembledLoop {
public:
  /// @param body  lines of GNU assembly between the label `loop:` and the return: %rdi is in, %rsi
  /// is out, %rdx is count, which is at least 1
  /// @throws InputError if it cannot be assembled
  explicit AssembledLoop(const std::string& body);
  ~AssembledLoop();
  AssembledLoop(const AssembledLoop&) = delete;
  AssembledLoop& operator=(const AssembledLoop&) = delete;
  void operator()(const void* in, void* out, long count) const { loop_(in, out, count); }

private:
  void* module_ = nullptr;
  void (*loop_)(const void* in, void* out, long count) = nullptr;
};

} // namespace dss
