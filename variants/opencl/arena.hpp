#pragma once
/// Memory of the engine's buffers in one piece, so that a device can take them all and tasks can say offsets.
#include "variants/engine/buffer.hpp"

namespace dss::opencl {

/// A reserved range of addresses that grows as buffers are made; untouched pages cost nothing. Nothing is released before its end.
class Arena final : public Memory {
public:
  /// @throws std::bad_alloc if no addresses can be had
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
  std::size_t used_ = page; ///< rows look before and behind themselves, where no lane counts
};

} // namespace dss::opencl
