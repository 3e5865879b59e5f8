#pragma once
/// Cells of a study: every combination of what a block of its JSON names.
#include "experiments/runner/study.hpp"
#include "experiments/runner/study_sets.hpp"
#include "variants/loader.hpp"

#include <string>
#include <vector>

namespace dss {

/// A variant by name. @throws InputError with the place, naming the nearest
const VariantStatus& known_variant(const std::string& name, const JsonPlace& place);

/// Adds the cells of a block of `study.scale`. One that an earlier block has named is measured once.
/// Every scene is loaded with its overrides. @throws InputError with the place of what is wrong
void add_block(const JsonPlace& place, const Sets& scale_sets, int cores, Study& study);

} // namespace dss
