#include "experiments/studies/kernels/attribution.hpp"
#include "experiments/base/clock.hpp"
#include "experiments/measure/ceilings/executed_mix.hpp"
#include "experiments/measure/ceilings/own_ceilings.hpp"
#include "experiments/measure/kernels/micro_case.hpp"
#include "experiments/measure/samples.hpp"
#include "experiments/run/plan/context.hpp"
#include "solver/error.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <memory>
#include <string_view>

namespace dss {
namespace {

/// Something that is timed in each round; ns is of an element and pass.
struct Timed {
  std::function<void()> pass;
  double elements; ///< a pass
  long passes = 1;
  std::vector<double> ns{};
  std::vector<std::string> time_utc{};
};

double seconds(Timed& timed) {
  const auto start = Clock::now();
  for (long pass = 0; pass < timed.passes; ++pass) timed.pass();
  return seconds_since(start);
}

/// A row kernel, and the bounds of its time.
struct RowPart {
  std::string name;
  int count; ///< a step
  const CompiledKernel* kernel;
  InstructionMix mix;
  std::string mix_missing; ///< why there is none
  std::unique_ptr<MicroWork> in_level, in_l1;
  std::unique_ptr<GeneratedMix> as_executed, without_stack;
  double bytes = 0; ///< an element
};

const char* ceiling_isa(const CompiledKernel& kernel) {
  const int bytes = kernel.lanes * (kernel.precision == Precision::f64 ? 8 : 4);
  return bytes == 64 ? "avx512" : bytes == 32 ? "avx2" : "scalar";
}

const CompiledKernel& row_kernel(const Plugin& plugin, const AttributionCase& one, bool is_last) {
  if (plugin.kernels != nullptr)
    for (const CompiledKernel& kernel : plugin.kernels())
      if (kernel.is_row && kernel.is_last == is_last && kernel.model == one.model &&
          kernel.precision == one.precision)
        return kernel;
  throw InputError(
      fmt::format("attribution: variant {} has no rows of model {}", plugin.name, name(one.model)));
}

RowPart row_part(const Plugin& plugin, const AttributionCase& one, bool is_last,
                 const std::string& level) {
  const CompiledKernel& kernel = row_kernel(plugin, one, is_last);
  RowPart part{kernel.name, is_last ? 1 : 3, &kernel, {}, {}, {}, {}, {}, {}, 0};
  const MicroCase in_level = kernel_case(plugin, kernel, level, 1);
  if (!in_level.skipped.empty())
    throw InputError(fmt::format("attribution: {}: {}", level, in_level.skipped));
  part.in_level = in_level.make();
  part.in_l1 = kernel_case(plugin, kernel, "L1", 1).make();
  part.bytes = in_level.bytes;
  const std::string isa = ceiling_isa(kernel), precision{name(one.precision)};
  try {
    part.mix = executed_mix(kernel);
    part.as_executed = std::make_unique<GeneratedMix>(part.mix, isa, precision);
    InstructionMix lean = part.mix;
    lean.loads -= lean.stack_loads, lean.stores -= lean.stack_stores;
    part.without_stack = std::make_unique<GeneratedMix>(lean, isa, precision);
  } catch (const InputError& error) {
    part.mix_missing = error.what();
  }
  return part;
}

/// All that is timed, by name.
using TimedParts = std::map<std::string, Timed>;

void time_rounds(TimedParts& parts, int rounds, double sample_s) {
  for (auto& [name, timed] : parts)
    for (double time = seconds(timed); time < sample_s; time = seconds(timed))
      timed.passes = std::max(timed.passes + 1,
                              long(double(timed.passes) * std::min(8.0, 1.1 * sample_s / time)));
  for (int round = 0; round < rounds; ++round)
    for (auto& [name, timed] : parts) {
      timed.time_utc.push_back(measurement_time());
      timed.ns.push_back(1e9 * seconds(timed) / (timed.elements * double(timed.passes)));
    }
}

/// Times of one round, by name; NaN for what was not timed.
using RoundTimes = std::function<double(const std::string& name)>;

/// A figure made from the times of a round.
using Figure = std::function<double(const RoundTimes&)>;

std::vector<double> figures(const TimedParts& parts, const Figure& figure) {
  std::vector<double> values;
  for (std::size_t round = 0; round < parts.begin()->second.ns.size(); ++round)
    values.push_back(figure([&](const std::string& name) {
      const auto found = parts.find(name);
      return found == parts.end() ? std::nan("") : found->second.ns[round];
    }));
  return values;
}

/// Its median over the rounds; NaN for what was not timed.
double over_rounds(const TimedParts& parts, const Figure& figure) {
  const std::vector<double> values = figures(parts, figure);
  return std::isnan(values.front()) ? values.front() : median(values);
}

/// The median with its interval, in columns NAME, NAME_low and NAME_high.
void put_figure(Record& row, const std::string& column, const TimedParts& parts,
                const Figure& figure) {
  const std::vector<double> values = figures(parts, figure);
  if (!std::isnan(values.front())) put_interval(row, column, estimate(values));
}

/// What a row kernel needs at least, by the times of a round: for its flops, its mix of
/// instructions, its traffic [ns].
double bound_ns(const RoundTimes& of, const RowPart& part, double traffic_ns) {
  return std::fmax(std::fmax(part.kernel->flops * of("peak"), of(part.name + " mix")), traffic_ns);
}

/// Which of these is the largest.
std::string limiter(const TimedParts& parts, const RowPart& part, double traffic_ns,
                    const std::string& level) {
  const double peak_ns = over_rounds(
                   parts, [&](const RoundTimes&of) { return part.kernel->flops * of("peak"); }),
               mix_ns =
                   over_rounds(parts, [&](const RoundTimes&of) { return of(part.name + " mix"); });
  if (traffic_ns > std::fmax(peak_ns, mix_ns)) return fmt::format("{} bandwidth", level);
  if (!(mix_ns > peak_ns)) return "arithmetic: fused multiply-adds alone";
  const double spilled = over_rounds(parts, [&](const RoundTimes& of) {
    return 1 - of(part.name + " lean") / of(part.name + " mix");
  });
  const std::string words = "instructions: not all are fused, and operands are in memory";
  return spilled < 0.03
             ? words
             : fmt::format("{}; {:.0f} % of the bound are registers spilled to the stack", words,
                           100 * spilled);
}

Record head_row(const AttributionCase& one, const std::string& part) {
  return {{"variant", one.variant},
          {"model", std::string(name(one.model))},
          {"precision", std::string(name(one.precision))},
          {"scene", "plate_paper"},
          {"n", fmt::format("{}", one.n)},
          {"threads", "1"},
          {"part", part},
          {"status", "ok"}};
}

/// Everything that was timed, as measured.
void record_rounds(const AttributionCase& one, const TimedParts& parts, RecordFile& raw) {
  for (const auto& [name, timed] : parts)
    for (std::size_t round = 0; round < timed.ns.size(); ++round) {
      const double elements = timed.elements * double(timed.passes);
      Record row = head_row(one, "");
      row["timed"] = name;
      row["round"] = fmt::format("{}", round);
      row["passes"] = fmt::format("{}", timed.passes);
      row["elements"] = number_text(elements);
      row["wall_s"] = number_text(timed.ns[round] * elements * 1e-9);
      row["time_utc"] = timed.time_utc[round];
      raw.append(row);
    }
}

void put_mix(const RowPart& part, const TimedParts& parts, Record& row) {
  const InstructionMix& m = part.mix;
  row["reason"] = part.mix_missing;
  if (part.as_executed == nullptr) return;
  for (const auto& [column, value] :
       std::initializer_list<std::pair<const char*, double>>{{"fma", m.fma},
                                                             {"sums", m.sums},
                                                             {"products", m.products},
                                                             {"shuffles", m.shuffles},
                                                             {"loads", m.loads},
                                                             {"stores", m.stores},
                                                             {"stack_loads", m.stack_loads},
                                                             {"stack_stores", m.stack_stores}})
    row[column] = number_text(value);
  const auto bound = [&](const char* column, const char* timed) {
    put_figure(row, column, parts,
               [&](const RoundTimes& of) { return part.count * of(part.name + timed); });
  };
  bound("mix_bound_ns", " mix");
  bound("mix_without_stack_bound_ns", " lean");
}

/// Times of a count of passes of a part; the record of a row kernel.
Record row_record(const AttributionCase& one, const TimedParts& parts, const RowPart& part,
                  const std::string& level, double traffic_ns, double l1_traffic_ns) {
  Record row = head_row(one, part.name);
  const auto put = [&](const char* column, const Figure& figure) {
    put_figure(row, column, parts, figure);
  };
  const double count = part.count;
  row["count_per_step"] = fmt::format("{}", part.count);
  put("measured_ns_per_element_step", [&](const RoundTimes& of) { return count * of(part.name); });
  put("measured_in_l1_ns", [&](const RoundTimes& of) { return count * of(part.name + " L1"); });
  put("share_of_step", [&](const RoundTimes& of) { return count * of(part.name) / of("step"); });
  row["flops_per_element_step"] = number_text(count * part.kernel->flops);
  put("share_of_peak",
      [&](const RoundTimes& of) { return part.kernel->flops * of("peak") / of(part.name); });
  put("peak_bound_ns",
      [&](const RoundTimes& of) { return count * part.kernel->flops * of("peak"); });
  row["traffic_bound_ns"] = number_text(count * traffic_ns);
  put("share_of_ceiling",
      [&](const RoundTimes& of) { return bound_ns(of, part, traffic_ns) / of(part.name); });
  put("share_of_ceiling_in_l1", [&](const RoundTimes& of) {
    return bound_ns(of, part, l1_traffic_ns) / of(part.name + " L1");
  });
  row["limiter"] = limiter(parts, part, traffic_ns, level);
  put_mix(part, parts, row);
  return row;
}

} // namespace

const std::vector<std::string>& attribution_columns() {
  static const std::vector<std::string> columns = {"variant",
                                                   "model",
                                                   "precision",
                                                   "scene",
                                                   "n",
                                                   "threads",
                                                   "part",
                                                   "count_per_step",
                                                   "measured_ns_per_element_step",
                                                   "measured_ns_per_element_step_low",
                                                   "measured_ns_per_element_step_high",
                                                   "share_of_step",
                                                   "share_of_step_low",
                                                   "share_of_step_high",
                                                   "measured_in_l1_ns",
                                                   "measured_in_l1_ns_low",
                                                   "measured_in_l1_ns_high",
                                                   "flops_per_element_step",
                                                   "share_of_peak",
                                                   "share_of_peak_low",
                                                   "share_of_peak_high",
                                                   "peak_bound_ns",
                                                   "peak_bound_ns_low",
                                                   "peak_bound_ns_high",
                                                   "mix_bound_ns",
                                                   "mix_bound_ns_low",
                                                   "mix_bound_ns_high",
                                                   "mix_without_stack_bound_ns",
                                                   "mix_without_stack_bound_ns_low",
                                                   "mix_without_stack_bound_ns_high",
                                                   "traffic_bound_ns",
                                                   "share_of_ceiling",
                                                   "share_of_ceiling_low",
                                                   "share_of_ceiling_high",
                                                   "share_of_ceiling_in_l1",
                                                   "share_of_ceiling_in_l1_low",
                                                   "share_of_ceiling_in_l1_high",
                                                   "limiter",
                                                   "sum_over_step",
                                                   "sum_over_step_low",
                                                   "sum_over_step_high",
                                                   "fma",
                                                   "sums",
                                                   "products",
                                                   "shuffles",
                                                   "loads",
                                                   "stores",
                                                   "stack_loads",
                                                   "stack_stores",
                                                   "status",
                                                   "reason"};
  return columns;
}

const std::vector<std::string>& attribution_raw_columns() {
  static const std::vector<std::string> columns = {"variant", "model",    "precision", "scene",
                                                   "n",       "threads",  "timed",     "round",
                                                   "passes",  "elements", "wall_s",    "time_utc"};
  return columns;
}

std::vector<Record> attribute_step(const AttributionCase& one, int rounds, double sample_s,
                                   const std::vector<Ceiling>& ceilings, RecordFile& raw) {
  const Plugin& plugin = load_variant(one.variant);
  const MicroCase step = step_case(plugin, one.model, one.precision, one.n, 1);
  const auto steps = step.make();
  std::vector<RowPart> rows;
  for (const bool is_last : {false, true})
    rows.push_back(row_part(plugin, one, is_last, step.level));
  const CompiledKernel& kernel = *rows.front().kernel;
  const std::string isa = ceiling_isa(kernel), precision{name(one.precision)};
  const GeneratedMix peak(peak_mix(isa == "scalar"), isa, precision);
  const double lanes = kernel.lanes,
               peak_flops_a_pass = peak_instructions * lanes * (isa == "scalar" ? 1 : 2);

  // Rows of n elements fill packs: what the rest of the last one costs is a step's, too.
  const double filled = one.n / (lanes * std::ceil(one.n / lanes));
  TimedParts parts;
  parts.try_emplace("step", Timed{[&] { steps->pass(); }, step.elements});
  parts.try_emplace("peak", Timed{[&] { peak.run(100); }, 100 * peak_flops_a_pass}); // ns a flop
  for (const RowPart& part : rows) {
    const double l1_elements = filled * kernel_case(plugin, *part.kernel, "L1", 1).elements;
    parts.try_emplace(part.name,
                      Timed{[&part] { part.in_level->pass(); },
                            filled * kernel_case(plugin, *part.kernel, step.level, 1).elements});
    parts.try_emplace(part.name + " L1", Timed{[&part] { part.in_l1->pass(); }, l1_elements});
    if (part.as_executed == nullptr) continue;
    parts.try_emplace(part.name + " mix",
                      Timed{[&part] { part.as_executed->run(100); }, 100 * lanes * filled});
    parts.try_emplace(part.name + " lean",
                      Timed{[&part] { part.without_stack->run(100); }, 100 * lanes * filled});
  }
  time_rounds(parts, rounds, sample_s);
  record_rounds(one, parts, raw);

  const auto traffic_ns = [&](const RowPart& part, const std::string& level) {
    return 1e9 * part.bytes /
           bandwidth(ceilings, level, 1); // NaN, and no bound, where it was not measured
  };
  std::vector<Record> records;
  for (const RowPart& part : rows)
    records.push_back(row_record(one, parts, part, step.level, traffic_ns(part, step.level),
                                 traffic_ns(part, "L1")));
  const auto sum = [&](const std::function<double(const RowPart&)>& figure) {
    double total = 0;
    for (const RowPart& part : rows) total += part.count * figure(part);
    return total;
  };
  const Figure rows_over_step = [&](const RoundTimes& of) {
    return sum([&](const RowPart& part) { return of(part.name); }) / of("step");
  };
  Record rest = head_row(one, "rest");
  rest["count_per_step"] = "1";
  put_figure(rest, "measured_ns_per_element_step", parts,
             [&](const RoundTimes& of) { return of("step") * (1 - rows_over_step(of)); });
  put_figure(rest, "share_of_step", parts,
             [&](const RoundTimes& of) { return 1 - rows_over_step(of); });
  rest["limiter"] = "what the rows by themselves do not explain; below zero: the step finds more "
                    "in nearer caches than they do";
  records.push_back(rest);
  Record whole = head_row(one, "step");
  whole["count_per_step"] = "1";
  put_figure(whole, "measured_ns_per_element_step", parts,
             [](const RoundTimes& of) { return of("step"); });
  whole["share_of_step"] = "1";
  whole["flops_per_element_step"] = number_text(step.flops);
  put_figure(whole, "share_of_peak", parts,
             [&](const RoundTimes& of) { return step.flops * of("peak") / of("step"); });
  put_figure(whole, "share_of_ceiling", parts, [&](const RoundTimes& of) {
    return sum([&](const RowPart& part) {
             return bound_ns(of, part, traffic_ns(part, step.level));
           }) /
           of("step");
  });
  put_figure(whole, "sum_over_step", parts, rows_over_step);
  whole["limiter"] = records.front().at("limiter");
  records.push_back(whole);
  return records;
}

} // namespace dss
