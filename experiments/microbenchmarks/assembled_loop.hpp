#pragma once
/// Machine code from assembly text, while the program runs. Needs `as` and `ld` (binutils).
#include <string>

namespace dss {

/// A function loop(in, out, count) of the System V ABI, given by its body.
class AssembledLoop {
public:
  /// @param body  lines of GNU assembly between the label `loop:` and the return: %rdi in, %rsi out, %rdx count, which is above zero
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
