#include "variants/opencl/arena.hpp"

#include <new>

namespace dss::opencl {

Arena::Arena() {
  constexpr std::size_t most = std::size_t(1) << 40, least = std::size_t(1) << 30;
  for (reserved_ = most; reserved_ >= least && start_ == nullptr; reserved_ /= 2) {
    void* const at = mmap(nullptr, reserved_ + page, PROT_READ | PROT_WRITE,
                          MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (at == MAP_FAILED) continue;
    start_ = mapped_ = static_cast<std::byte*>(at);
    break;
  }
  if (start_ == nullptr) throw std::bad_alloc();
  const std::size_t over = reinterpret_cast<std::size_t>(start_) % page;
  if (over > 0) start_ += page - over; // begins on a huge page
}

Arena::~Arena() { munmap(mapped_, reserved_ + page); }

void* Arena::allocate(std::size_t bytes) {
  const std::size_t alignment = bytes >= 2 * page ? page : line;
  const std::size_t begin = (used_ + alignment - 1) / alignment * alignment, end = begin + bytes;
  if (end + page > reserved_) throw std::bad_alloc();
  used_ = (end + line - 1) / line * line;
  if (alignment == page) madvise(start_ + begin, bytes, MADV_HUGEPAGE);
  return start_ + begin;
}

} // namespace dss::opencl
