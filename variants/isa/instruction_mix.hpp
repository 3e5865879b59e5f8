#pragma once

namespace dss {

/// Numbers of instructions of a pass: vector arithmetic (scalar in scalar code), loads and stores.
struct InstructionMix {
  double fma = 0; ///< fused multiply-adds
  /// Sums include differences, and products include quotients. Some processors have separate units
  /// for each.
  double sums = 0, products = 0;
  double shuffles = 0; ///< moves of lanes
  double loads = 0;    ///< operands in memory and separate load instructions
  double stores = 0;
  /// The part of loads and stores that is on the stack, because there were too few registers.
  double stack_loads = 0, stack_stores = 0;
  double rest = 0; ///< moves, addresses, counters, branches
};

} // namespace dss
