#include "experiments/studies/study.hpp"
#include "experiments/studies/stability/stability_study.hpp"
#include "variants/isa/denormals.hpp"

#include <fmt/format.h>

namespace dss {
namespace {

class StepLimits : public Study {
public:
  explicit StepLimits(const StudyFile& file) : study_(read_stability(file)) {}

  std::string plan(const StudyPaths&) const override {
    return fmt::format("{}: step limits of every explicit method on {} problems\n", study_.name,
                       study_.cases.size());
  }

  StudyResult run(const StudyRun&) override {
    flush_denormals();
    const Table limits = stability_table(study_), energy = stability_energy_table(study_);
    return {{{study_.name, limits},
             {study_.name + "_energy", energy},
             {study_.name + "_map", stability_map_table(study_)}},
            stability_text(study_, limits, energy),
            !has_failed_rows(limits) && !has_failed_rows(energy)};
  }

private:
  const StabilityStudy study_;
};

} // namespace

extern const StudyKind stability_kind;
const StudyKind stability_kind{"stability", read_study<StepLimits>};

} // namespace dss
