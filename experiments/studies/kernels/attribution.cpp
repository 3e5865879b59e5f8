#include "experiments/studies/kernels/attribution.hpp"
#include "experiments/measure/ceilings/executed_mix.hpp"
#include "experiments/measure/ceilings/own_ceilings.hpp"
#include "experiments/measure/kernels/micro_case.hpp"
#include "experiments/measure/samples.hpp"
#include "experiments/studies/kernels/timed_parts.hpp"
#include "solver/error.hpp"
#include "variants/api/message_order.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <string_view>

namespace dss {
namespace {

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

const InstructionSet& isa_of(const CompiledKernel& kernel) {
  return instruction_set_of(kernel.lanes, int(number_bytes(kernel.precision)));
}

const CompiledKernel& row_kernel(const Plugin& plugin, const AttributionCase& one, bool is_last) {
  if (plugin.kernels != nullptr)
    for (const CompiledKernel& kernel : plugin.kernels())
      if (kernel.is_row && kernel.is_last == is_last && !kernel.is_material &&
          kernel.model == one.model && kernel.precision == one.precision)
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
  const InstructionSet& isa = isa_of(kernel);
  const bool is_double = one.precision == Precision::f64;
  try {
    part.mix = executed_mix(kernel);
    part.as_executed = std::make_unique<GeneratedMix>(part.mix, isa, is_double);
    InstructionMix lean = part.mix;
    lean.loads -= lean.stack_loads, lean.stores -= lean.stack_stores;
    part.without_stack = std::make_unique<GeneratedMix>(lean, isa, is_double);
  } catch (const InputError& error) {
    part.mix_missing = error.what();
  }
  return part;
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

/// What is timed for a case: the step, the peak, and each row kernel on the step's level, in L1, as
/// its instructions and as those without the stack.
TimedParts parts_of(const AttributionCase& one, const MicroCase& step, MicroWork& steps,
                    const std::vector<RowPart>& rows, const GeneratedMix& peak) {
  const Plugin& plugin = load_variant(one.variant);
  const CompiledKernel& kernel = *rows.front().kernel;
  const double lanes = kernel.lanes;
  const double peak_flops_a_pass = peak_instructions * lanes * (isa_of(kernel).is_scalar() ? 1 : 2);
  // Rows of n elements fill packs: what the rest of the last one costs is a step's, too.
  const double filled = one.n / (lanes * std::ceil(one.n / lanes));
  TimedParts parts;
  parts.try_emplace("step", Timed{[&] { steps.pass(); }, step.elements});
  parts.try_emplace("peak", Timed{[&] { peak.run(100); }, 100 * peak_flops_a_pass}); // ns a flop
  for (const RowPart& part : rows) {
    const auto elements_on = [&](const std::string& level) {
      return filled * kernel_case(plugin, *part.kernel, level, 1).elements;
    };
    parts.try_emplace(part.name,
                      Timed{[&part] { part.in_level->pass(); }, elements_on(step.level)});
    parts.try_emplace(part.name + " L1", Timed{[&part] { part.in_l1->pass(); }, elements_on("L1")});
    if (part.as_executed == nullptr) continue;
    parts.try_emplace(part.name + " mix",
                      Timed{[&part] { part.as_executed->run(100); }, 100 * lanes * filled});
    parts.try_emplace(part.name + " lean",
                      Timed{[&part] { part.without_stack->run(100); }, 100 * lanes * filled});
  }
  return parts;
}

/// Sum of a figure over all row kernels of a step.
double sum_of_rows(const std::vector<RowPart>& rows,
                   const std::function<double(const RowPart&)>& figure) {
  double total = 0;
  for (const RowPart& part : rows) total += part.count * figure(part);
  return total;
}

/// The record of what the rows alone do not explain.
Record rest_record(const AttributionCase& one, const TimedParts& parts,
                   const Figure& rows_over_step) {
  Record row = head_row(one, "rest");
  row["count_per_step"] = "1";
  put_figure(row, "measured_ns_per_element_step", parts,
             [&](const RoundTimes& of) { return of("step") * (1 - rows_over_step(of)); });
  put_figure(row, "share_of_step", parts,
             [&](const RoundTimes& of) { return 1 - rows_over_step(of); });
  row["limiter"] = "what the rows by themselves do not explain; below zero: the step finds more "
                   "in nearer caches than they do";
  return row;
}

/// The record of the whole step.
/// @param bound  what its rows need at least [ns]
Record step_record(const AttributionCase& one, const TimedParts& parts, double flops,
                   const Figure& bound, const Figure& rows_over_step) {
  Record row = head_row(one, "step");
  row["count_per_step"] = "1";
  put_figure(row, "measured_ns_per_element_step", parts,
             [](const RoundTimes& of) { return of("step"); });
  row["share_of_step"] = "1";
  row["flops_per_element_step"] = number_text(flops);
  put_figure(row, "share_of_peak", parts,
             [&](const RoundTimes& of) { return flops * of("peak") / of("step"); });
  put_figure(row, "share_of_ceiling", parts,
             [&](const RoundTimes& of) { return bound(of) / of("step"); });
  put_figure(row, "sum_over_step", parts, rows_over_step);
  return row;
}

} // namespace

std::vector<Record> attribute_step(const AttributionCase& one, int rounds, double sample_s,
                                   const std::vector<Ceiling>& ceilings, RecordFile& raw) {
  const Plugin& plugin = load_variant(one.variant);
  const MicroCase step = step_case(plugin, one.model, one.precision, one.n, 1);
  const auto steps = step.make();
  std::vector<RowPart> rows;
  for (const bool is_last : {false, true})
    rows.push_back(row_part(plugin, one, is_last, step.level));
  const InstructionSet& isa = isa_of(*rows.front().kernel);
  const GeneratedMix peak(peak_mix(isa.is_scalar()), isa, one.precision == Precision::f64);
  TimedParts parts = parts_of(one, step, *steps, rows, peak);
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
  const Figure rows_over_step = [&](const RoundTimes& of) {
    return sum_of_rows(rows, [&](const RowPart& part) { return of(part.name); }) / of("step");
  };
  const Figure bound = [&](const RoundTimes& of) {
    return sum_of_rows(rows, [&](const RowPart& part) {
      return bound_ns(of, part, traffic_ns(part, step.level));
    });
  };
  records.push_back(rest_record(one, parts, rows_over_step));
  records.push_back(step_record(one, parts, step.flops, bound, rows_over_step));
  records.back()["limiter"] = records.front().at("limiter");
  return records;
}

} // namespace dss
