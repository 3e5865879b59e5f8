#include "variants/isa/instruction_set.hpp"
#include "variants/isa/cpu_features.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

namespace dss {

static constexpr InstructionSet all_instruction_sets[] = {
#include "variants/instruction_sets.inc"
};

bool InstructionSet::is_here() const { return missing_feature(needs).empty(); }

std::span<const InstructionSet> instruction_sets() { return all_instruction_sets; }

const InstructionSet& instruction_set(std::string_view name) {
  for (const InstructionSet& isa : all_instruction_sets)
    if (isa.name == name) return isa;
  throw std::out_of_range(fmt::format("variants/isa has no {} for this processor", name));
}

const InstructionSet& instruction_set_of(int lanes, int number_bytes) {
  for (const InstructionSet& isa : all_instruction_sets)
    if (isa.lanes(number_bytes) == lanes) return isa;
  throw std::out_of_range(fmt::format("variants/isa has no packs of {} lanes", lanes));
}

} // namespace dss
