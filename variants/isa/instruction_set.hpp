#pragma once
/// The instruction sets of this architecture, as variants/isa/NAME/isa.json describes them.
#include <span>
#include <string_view>

namespace dss {

struct InstructionSet {
  const char* name;          ///< of its folder
  const char* march;         ///< as in the compiler's -march=
  const char* needs;         ///< CPU features, comma-separated
  const char* register_name; ///< without its number
  int registers;
  int pack_bytes; ///< 0: a pack is a scalar
  /// Names of its ceilings. On x86 they are those of likwid-bench.
  const char *peak_f64, *peak_f32, *stream_suffix;

  bool is_scalar() const { return pack_bytes == 0; }
  /// Lanes of a pack of f64 or f32.
  int lanes(int number_bytes) const { return is_scalar() ? 1 : pack_bytes / number_bytes; }
  /// True if this CPU has its features.
  bool is_here() const;
};

/// Narrowest packs first.
std::span<const InstructionSet> instruction_sets();

/// @throws std::out_of_range if this architecture has no such instruction set
const InstructionSet& instruction_set(std::string_view name);

/// The instruction set whose packs have so many lanes.
/// @throws std::out_of_range if there is none
const InstructionSet& instruction_set_of(int lanes, int number_bytes);

} // namespace dss
