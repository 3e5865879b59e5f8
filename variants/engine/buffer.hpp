#pragma once
/// Zeroed memory, aligned for packs; large pieces lie on huge pages (DESIGN.md section 4, item 6).
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <sys/mman.h>

namespace dss {

/// A source of memory for buffers: the heap, or one piece that a device can take as a whole.
class Memory {
public:
  static constexpr std::size_t page = std::size_t(2) << 20, line = 64;
  virtual ~Memory() = default;
  /// Allocates zeroed memory, aligned to a cache line, or to a huge page if it is large.
  /// @throws std::bad_alloc
  virtual void* allocate(std::size_t bytes) {
    const std::size_t alignment = bytes >= 2 * page ? page : line;
    void* const at = std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
    if (at == nullptr) throw std::bad_alloc();
    if (alignment == page) madvise(at, bytes, MADV_HUGEPAGE);
    return std::memset(at, 0, bytes);
  }
  virtual void release(void* at) { std::free(at); }
  static Memory& heap() {
    static Memory memory;
    return memory;
  }
};

/// An array of `count` numbers, all zero at first.
template <class T>
class Buffer {
public:
  Buffer() = default;
  /// @param memory  outlives the buffer
  /// @throws std::bad_alloc
  explicit Buffer(std::size_t count, Memory& memory = Memory::heap())
      : size_(count), data_(nullptr, {&memory}) {
    if (count > 0) data_.reset(static_cast<T*>(memory.allocate(count * sizeof(T))));
  }
  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return size_ * sizeof(T); }
  bool empty() const { return size_ == 0; }

private:
  struct Release {
    Memory* memory = nullptr;
    void operator()(T* p) const { memory->release(p); }
  };
  std::size_t size_ = 0;
  std::unique_ptr<T[], Release> data_;
};

} // namespace dss
