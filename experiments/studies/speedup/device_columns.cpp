#include "experiments/studies/speedup/device_columns.hpp"
#include "experiments/studies/speedup/scaling.hpp"
#include "kernels/model.hpp"
#include "variants/api/member.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace dss {
namespace {

/// Ceilings of the device, measured beside the runs.
void put_ceilings(const CellSample& sample, Record& row) {
  for (const char* column : {"triad_bytes_per_s", "peak_flops_per_s"}) {
    const std::vector<double> numbers = numbers_of(sample, column);
    row[column] = numbers.empty() ? "" : number_text(median(numbers));
  }
}

/// Shares of what the device was measured to do at best.
void put_shares_of_ceilings(const Cell& cell, Record& row) {
  const double speed = number_in(row, "element_steps_per_s");
  const double triad = number_in(row, "triad_bytes_per_s"),
               peak = number_in(row, "peak_flops_per_s");
  row["bandwidth_share"] = number_text(speed * 2 * state_bytes(cell.model, cell.precision) / triad);
  if (cell.integrator == "rk4")
    row["peak_share"] = number_text(
        speed * descriptor(find_model(cell.model).value_or(Model::spatial)).flops.rk4_step() /
        peak);
}

/// However many steps: times are compared by step.
bool is_same_problem(const Cell& a, Cell b) {
  b.steps = a.steps;
  return !b.is_twin && b.ranks == 1 && a.problem_key() == b.problem_key();
}

/// The cell with the state resident on the device, else as `cell`.
const Cell* resident_cell(const CellStudy& study, const Cell& cell) {
  if (cell.variant != "opencl-rhs") return nullptr;
  Cell like = cell;
  like.variant = "opencl";
  const auto found = std::ranges::find_if(study.cells, [&](const Cell& other) {
    return is_same_problem(like, other) && other.variant == "opencl" &&
           other.device == cell.device && other.threads == cell.threads;
  });
  return found == study.cells.end() ? nullptr : &*found;
}

/// Speed-up of a hybrid over the fastest single executor of the study.
void put_against_fastest(const CellStudy& study, const StudySamples& samples, const Cell& cell,
                         Record& row) {
  std::optional<Estimate> least;
  for (const Cell& other : study.cells) {
    if (!other.hybrid.empty() || !is_same_problem(cell, other)) continue;
    const auto speedup = samples.speedup(other, cell);
    if (!speedup || (least && least->median <= speedup->median)) continue;
    least = speedup;
    row["fastest_alone"] = other.label();
  }
  if (least) put_interval(row, "speedup_vs_fastest_alone", *least);
}

/// The variant that computed: "auto" is a name for the fastest one.
std::string variant_of(const Member& member, const std::string& used) {
  return member.variant == "auto" ? used.substr(0, used.find_first_of("@:, ")) : member.variant;
}

/// Throughput of a hybrid over the sum of its members' alone, if the study has all of them.
double of_sum(const CellStudy& study, const StudySamples& samples, const Cell& cell,
              std::string used) {
  double inverse = 0;
  for (const Member& member : parse_members(cell.hybrid)) {
    const std::string variant = variant_of(member, used);
    used = used.substr(std::min(
        used.size(), used.find("; ") == std::string::npos ? used.size() : used.find("; ") + 2));
    const auto alone = std::ranges::find_if(study.cells, [&](const Cell& other) {
      return other.hybrid.empty() && is_same_problem(cell, other) && other.variant == variant &&
             other.device == member.device && other.threads == member.threads;
    });
    if (alone == study.cells.end()) return std::nan("");
    const auto speedup = samples.speedup(*alone, cell);
    if (!speedup) return std::nan("");
    inverse += 1 / speedup->median;
  }
  return 1 / inverse;
}

} // namespace

double state_bytes(const std::string& model, const std::string& precision) {
  // f32c keeps two numbers of four bytes a field
  return double(descriptor(*find_model(model)).fields.size()) * (precision == "f32" ? 4.0 : 8.0);
}

const std::vector<std::string>& device_columns() {
  static const std::vector<std::string> columns = {"speedup_vs_resident",
                                                   "speedup_vs_resident_low",
                                                   "speedup_vs_resident_high",
                                                   "fastest_alone",
                                                   "speedup_vs_fastest_alone",
                                                   "speedup_vs_fastest_alone_low",
                                                   "speedup_vs_fastest_alone_high",
                                                   "of_sum_of_members",
                                                   "triad_bytes_per_s",
                                                   "bandwidth_share",
                                                   "peak_flops_per_s",
                                                   "peak_share"};
  return columns;
}

void put_devices(const CellStudy& study, const StudySamples& samples, const Cell& cell,
                 Record& row) {
  const CellSample* sample = samples.of(cell);
  if (sample == nullptr || sample->is_empty()) return;
  put_ceilings(*sample, row);
  put_shares_of_ceilings(cell, row);
  if (const Cell* resident = resident_cell(study, cell))
    if (const auto speedup = samples.speedup(*resident, cell))
      put_interval(row, "speedup_vs_resident", *speedup);
  if (cell.hybrid.empty()) return;
  put_against_fastest(study, samples, cell, row);
  if (cell.hybrid != "auto")
    row["of_sum_of_members"] = number_text(of_sum(study, samples, cell, row["members"]));
}

} // namespace dss
