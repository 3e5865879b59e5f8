#pragma once
/// Zeroed memory aligned for packs, on huge pages where it is large (DESIGN.md section 4, item 6).
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <sys/mman.h>

namespace dss {

template <class T>
class Buffer {
public:
  Buffer() = default;
  /// @throws std::bad_alloc
  explicit Buffer(std::size_t count) : size_(count) {
    constexpr std::size_t page = std::size_t(2) << 20, line = 64;
    const std::size_t bytes = count * sizeof(T), alignment = bytes >= 2 * page ? page : line;
    data_.reset(static_cast<T*>(std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment)));
    if (data_ == nullptr && count > 0) throw std::bad_alloc();
    if (alignment == page) madvise(data_.get(), bytes, MADV_HUGEPAGE);
    if (count > 0) std::memset(static_cast<void*>(data_.get()), 0, bytes);
  }
  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return size_ * sizeof(T); }
  bool empty() const { return size_ == 0; }

private:
  struct Free {
    void operator()(T* p) const { std::free(p); }
  };
  std::unique_ptr<T[], Free> data_;
  std::size_t size_ = 0;
};

} // namespace dss
