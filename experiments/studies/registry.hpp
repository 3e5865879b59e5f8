#pragma once
/// The list of all kinds of study.
#include "experiments/studies/study.hpp"

#include <vector>

namespace dss {

/// All kinds. A kind that claims keys of another kind comes before it.
const std::vector<const StudyKind*>& study_kinds();

} // namespace dss
