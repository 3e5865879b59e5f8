#include "experiments/measure/ceilings/generated_code.hpp"

#include <cstdlib>

namespace dss {
namespace {

template <class T>
void fill(std::byte* memory) {
  T* numbers = reinterpret_cast<T*>(memory);
  const std::size_t a_line = MixPage::line / sizeof(T);
  for (std::size_t n = 0; n < MixPage::bytes / sizeof(T); ++n) {
    const double starts[MixPage::constants] = {MixPage::factor, MixPage::term, MixPage::small_term,
                                               MixPage::start};
    const double value =
        n / a_line < MixPage::constants ? starts[n / a_line] : 0.95 + 1e-3 * double(n * 7919 % 101);
    numbers[n] = T(value + 1e-4 * double(n % a_line));
  }
}

} // namespace

GeneratedMix::GeneratedMix(const InstructionMix& mix, const InstructionSet& isa, bool is_double)
    : memory_(static_cast<std::byte*>(std::aligned_alloc(MixPage::bytes, 2 * MixPage::bytes))),
      loop_(mix_loop(mix, isa, is_double)) {
  for (std::byte* half : {memory_.get(), memory_.get() + MixPage::bytes})
    is_double ? fill<double>(half) : fill<float>(half);
}

void GeneratedMix::run(long passes) const {
  loop_(memory_.get(), memory_.get() + MixPage::bytes + MixPage::first_store_line * MixPage::line,
        passes);
}

} // namespace dss
