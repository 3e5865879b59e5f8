#pragma once
/// One piece of memory for all buffers of the engine. A device can take it as a whole, and tasks
/// can give offsets in place of addresses.
#include "variants/engine/buffer.hpp"

namespace dss::opencl {

/// A reserved range of addresses, used from its start as buffers are made. Untouched pages cost
/// nothing. Memory is released only when the arena ends.
class Arena final : public Memory {
public:
  /// @throws std::bad_alloc if no range of addresses is free
  Arena();
  ~Arena() override;
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;
  void* allocate(std::size_t bytes) override;
  void release(void*) override {}
  std::byte* start() const { return start_; }
  std::size_t bytes() const { return used_; }

private:
  std::byte *mapped_ = nullptr, *start_ = nullptr;
  std::size_t reserved_ = 0;
  /// Not zero: rows also read in front of themselves; these numbers do not count.
  std::size_t used_ = page;
};

} // namespace dss::opencl
