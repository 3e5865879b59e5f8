#include "experiments/studies/registry.hpp"

// A kind of study NAME is the folder NAME, which defines NAME_kind, and one word here.
#define DSS_EACH_KIND(kind)                                                                        \
  kind(work_precision) kind(speedup) kind(cluster) kind(advise) kind(balance) kind(chain)          \
      kind(continuum) kind(error_budget) kind(failures) kind(kernels) kind(model_ladder)           \
          kind(mixed_nodes) kind(paper) kind(stability) kind(statics) kind(verification)

namespace dss {

#define DSS_DECLARE(name) extern const StudyKind name##_kind;
DSS_EACH_KIND(DSS_DECLARE)
#undef DSS_DECLARE

const std::vector<const StudyKind*>& study_kinds() {
#define DSS_LIST(name) &name##_kind,
  static const std::vector<const StudyKind*> kinds = {DSS_EACH_KIND(DSS_LIST)};
#undef DSS_LIST
  return kinds;
}

} // namespace dss
