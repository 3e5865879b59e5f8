#include "variants/opencl/halo_rows.hpp"

#include "solver/error.hpp"
#include "variants/engine/packs.hpp"

#include <algorithm>
#include <utility>

namespace dss::opencl {

template <class T, int W>
HaloRows<T, W>::~HaloRows() {
  mappings_.clear();
  try {
    queue().finish();
  } catch (const InputError&) { // the call that met the error first has reported it
  }
}

// With CL_MEM_ALLOC_HOST_PTR drivers of GPUs give pinned memory.
template <class T, int W>
void HaloRows<T, W>::make_images(std::vector<Row> rows) {
  std::erase_if(
      rows, [&](const Row& row) { return problem_.is_shared() || images_.contains(row.numbers); });
  if (rows.empty()) return;
  std::ranges::sort(rows);
  rows.erase(std::ranges::unique(rows).begin(), rows.end());
  std::size_t bytes = 0;
  for (const Row& row : rows) bytes += row.count * sizeof(T);
  pinned_.push_back(queue().make_buffer(bytes, CL_MEM_READ_WRITE | CL_MEM_ALLOC_HOST_PTR));
  queue().set_counting(false);
  mappings_.emplace_back(
      new Mapping(queue().map(pinned_.back(), 0, bytes, CL_MAP_READ | CL_MAP_WRITE)));
  queue().set_counting(true);
  T* image = mappings_.back()->template as<T>().data();
  for (const Row& row : rows) {
    std::copy_n(row.numbers, row.count, image);
    images_[row.numbers] = std::exchange(image, image + row.count);
  }
}

template <class T, int W>
void HaloRows<T, W>::add(Ranges& ranges, Range range) {
  const auto touches = [&](const Range& known) {
    return known.from <= range.to && range.from <= known.to &&
           known.image - range.image == known.from - range.from;
  };
  for (auto known = ranges.begin(); known != ranges.end();) {
    if (!touches(*known)) {
      ++known;
      continue;
    }
    range = {std::min(range.from, known->from), std::max(range.to, known->to),
             std::min(range.image, known->image)};
    known = ranges.erase(known);
  }
  ranges.push_back(range);
}

template <class T, int W>
cl::Event HaloRows<T, W>::fetch(const Ranges& ranges) {
  cl::Event done;
  if (problem_.is_shared())
    problem_.to_host({});
  else
    for (const Range& range : ranges)
      done = queue().read(problem_.arena(), place(range.from),
                          std::as_writable_bytes(std::span(range.image, range.to - range.from)),
                          Wait::no);
  return done;
}

template <class T, int W>
void HaloRows<T, W>::bring(const Ranges& ranges) {
  if (problem_.is_shared())
    problem_.to_device({});
  else
    for (const Range& range : ranges)
      queue().write(problem_.arena(), place(range.from),
                    std::as_bytes(std::span(range.image, range.to - range.from)), Wait::no);
}

template <class T, int W>
void HaloRows<T, W>::fetch_from_arena(const Ranges& ranges) const {
  for (const Range& range : ranges)
    if (range.image != range.from) std::copy(range.from, range.to, range.image);
}

template <class T, int W>
void HaloRows<T, W>::bring_to_arena(const Ranges& ranges) const {
  for (const Range& range : ranges)
    if (range.image != range.from) std::copy_n(range.image, range.to - range.from, range.from);
}

#define DSS_INSTANTIATE(T, W) template class HaloRows<T, W>;
DSS_EACH_PACK(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE

} // namespace dss::opencl
