#include "experiments/run/guard/flipped_bit.hpp"
#include "solver/error.hpp"

#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <string>
#include <vector>

namespace dss {
namespace {

/// @param stays  the bit becomes 1, else its opposite
template <class T, class Bits>
T with_wrong_bit(T number, int bit, bool stays) {
  const Bits bits = std::bit_cast<Bits>(number), mask = Bits(1) << bit;
  return std::bit_cast<T>(stays ? bits | mask : bits ^ mask);
}

} // namespace

std::optional<FlippedBit> FlippedBit::of_environment() {
  const char* text = std::getenv("DSSBENCH_FLIP");
  if (text == nullptr) return std::nullopt;
  FlippedBit flip;
  int end = 0;
  std::sscanf(text, "%ld:%zu:%d:%d%n", &flip.step_, &flip.element_, &flip.number_, &flip.bit_,
              &end);
  const std::string rest = end > 0 ? text + end : "?";
  flip.stays_ = rest == ":stays";
  if ((!rest.empty() && !flip.stays_) || flip.step_ < 0 || flip.number_ < 0 || flip.bit_ < 0)
    throw InputError(fmt::format("DSSBENCH_FLIP={}: give STEP:ELEMENT:NUMBER:BIT, and :stays if "
                                 "the bit stays wrong",
                                 text));
  return flip;
}

void FlippedBit::require_within(const RunPlan& plan, Executor& executor) const {
  const int bits = plan.precision == Precision::f64 ? 64 : 32, numbers = kept_fields(executor);
  const std::size_t elements = plan.scene.problem.lattice.element_count;
  if (plan.adaptive) throw InputError("DSSBENCH_FLIP: steps must be equal; leave --rtol out");
  if (step_ >= plan.steps || element_ >= elements || number_ >= numbers || bit_ >= bits)
    throw InputError(fmt::format("DSSBENCH_FLIP: the run has {} steps, {} elements of {} numbers "
                                 "of {} bits",
                                 plan.steps, elements, numbers, bits));
}

void FlippedBit::apply(Executor& executor, long step, Precision precision) {
  if (stays_ ? step < step_ : step != step_ || is_done_) return;
  is_done_ = true;
  std::vector<double> kept(std::size_t(kept_fields(executor)));
  save(executor, element_, kept);
  double& number = kept[std::size_t(number_)];
  number = precision == Precision::f64
               ? with_wrong_bit<double, std::uint64_t>(number, bit_, stays_)
               : double(with_wrong_bit<float, std::uint32_t>(float(number), bit_, stays_));
  restore(executor, element_, kept);
}

} // namespace dss
