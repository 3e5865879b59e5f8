#include "experiments/measure/kernels/micro_run.hpp"
#include "experiments/base/clock.hpp"
#include "experiments/measure/kernels/likwid_markers.hpp"
#include "experiments/run/plan/context.hpp"
#include "solver/cores.hpp"
#include "solver/error.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <random>
#include <set>

namespace dss {
namespace {

constexpr double warm_up_s = 1e-3, least_cpu_share = 0.97;

/// Preparation of a case in its first round: number of passes per sample, and its check.
struct Prepared {
  long passes = 0;
  double error = 0;
  std::string check;
  std::string cannot; ///< reason why it cannot run here, or empty
};

/// Number of passes so that a sample lasts at least sample_s, estimated by a first run.
long passes_for(const MicroCase& one, double sample_s) {
  const auto work = one.make();
  work->pass();
  long passes = 1;
  for (;; passes *= 4) {
    const auto start = Clock::now();
    for (long pass = 0; pass < passes; ++pass) work->pass();
    const double time = seconds_since(start);
    if (time >= warm_up_s)
      return std::max(1L, std::lround(std::ceil(sample_s * double(passes) / time)));
  }
}

/// The loop that Google Benchmark times.
void run_case(benchmark::State& state, const MicroCase& one) {
  const auto work = one.make();
  work->pass();
  {
    const MarkedRegion region(one.cell());
    for (auto _ : state) {
      work->pass();
      benchmark::ClobberMemory();
    }
  }
  const double a_thread = one.elements / (one.is_threaded_inside ? 1 : one.threads);
  state.counters["elements_per_s"] =
      benchmark::Counter(double(state.iterations()) * a_thread, benchmark::Counter::kIsRate);
}

/// Passes each run to a function instead of printing it.
class Recorder : public benchmark::BenchmarkReporter {
public:
  explicit Recorder(std::function<void(const Run&)> record) : record_(std::move(record)) {}
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs)
      if (run.run_type == Run::RT_Iteration) record_(run);
  }

private:
  std::function<void(const Run&)> record_;
};

Record head_of(const std::string& experiment, const MicroCase& one) {
  return {{"experiment", experiment},
          {"cell", one.cell()},
          {"kernel", one.kernel},
          {"model", std::string(name(one.model))},
          {"precision", std::string(name(one.precision))},
          {"variant", one.variant},
          {"isa", one.isa},
          {"level", one.level},
          {"n", one.n > 0 ? fmt::format("{}", one.n) : ""},
          {"working_set_bytes", fmt::format("{}", one.working_set_bytes)},
          {"threads", fmt::format("{}", one.threads)},
          {"cores", fmt::format("{}", usable_cores())},
          {"flops_per_element", number_text(one.flops)},
          {"bytes_per_element", number_text(one.bytes)},
          {"time_utc", measurement_time()}};
}

Record measured_record(const std::string& experiment, const MicroCase& one,
                       const Prepared& prepared, int repetition,
                       const benchmark::BenchmarkReporter::Run& run) {
  Record record = head_of(experiment, one);
  const double rate = run.counters.at("elements_per_s"),
               elements = double(prepared.passes) * one.elements;
  const double share = run.cpu_accumulated_time / run.real_accumulated_time;
  record["repetition"] = fmt::format("{}", repetition);
  record["steps"] = fmt::format("{}", prepared.passes);
  record["elements"] = number_text(one.elements);
  record["wall_s"] = record["sample_s"] = number_text(elements / rate);
  record["contaminated"] =
      !one.is_threaded_inside && one.threads == 1 && share < least_cpu_share ? "true" : "false";
  record["elements_per_s"] = number_text(rate);
  record["check"] = prepared.check;
  record["check_error"] = one.error ? number_text(prepared.error) : "";
  record["check_tolerance"] = number_text(one.tolerance());
  record["status"] = prepared.check == "passed" ? "ok" : "wrong";
  if (prepared.check != "passed")
    record["reason"] = one.n > 0 ? "its results are not those of the reference variant"
                                 : "its results are not those of long double";
  return record;
}

Prepared prepare_case(const MicroCase& one, double sample_s) {
  Prepared prepared;
  try {
    prepared.error = one.error ? one.error() : 0;
    prepared.check = prepared.error <= one.tolerance() ? "passed" : "failed"; // NaN fails
    prepared.passes = passes_for(one, sample_s);
  } catch (const InputError& error) {
    prepared.cannot = error.what();
  }
  return prepared;
}

} // namespace

const std::vector<std::string>& micro_columns() {
  static const std::vector<std::string> columns = {"experiment",
                                                   "cell",
                                                   "kernel",
                                                   "model",
                                                   "precision",
                                                   "variant",
                                                   "isa",
                                                   "level",
                                                   "n",
                                                   "working_set_bytes",
                                                   "threads",
                                                   "cores",
                                                   "flops_per_element",
                                                   "bytes_per_element",
                                                   "repetition",
                                                   "steps",
                                                   "elements",
                                                   "wall_s",
                                                   "sample_s",
                                                   "contaminated",
                                                   "elements_per_s",
                                                   "check",
                                                   "check_error",
                                                   "check_tolerance",
                                                   "status",
                                                   "reason",
                                                   "time_utc"};
  return columns;
}

void run_micro_cases(const std::string& experiment, const std::vector<MicroCase>& cases,
                     const MicroRules& rules, RecordFile& records,
                     const std::function<void(double, double, const std::string&)>& done) {
  std::set<std::pair<std::string, std::string>> present;
  for (const Record& record : records.present())
    present.emplace(text_in(record, "cell"), text_in(record, "repetition"));
  std::map<std::string, Prepared> prepared;
  std::vector<const MicroCase*> order;
  for (const MicroCase& one : cases) {
    if (one.skipped.empty()) {
      order.push_back(&one);
    } else if (!present.contains({one.cell(), ""})) {
      Record record = head_of(experiment, one);
      record["status"] = "skipped", record["reason"] = one.skipped;
      records.append(record);
    }
  }
  std::mt19937 shuffler(1);
  double finished = 0;
  const double total = double(order.size()) * rules.repetitions;
  for (int repetition = 0; repetition < rules.repetitions; ++repetition) {
    std::ranges::shuffle(order, shuffler);
    for (const MicroCase* one : order) {
      done(finished++, total, one->cell());
      if (present.contains({one->cell(), fmt::format("{}", repetition)})) continue;
      const bool is_new = !prepared.contains(one->cell());
      Prepared& own = prepared[one->cell()];
      if (is_new) own = prepare_case(*one, rules.sample_s);
      // such as a device without double precision; the other cases continue
      if (!own.cannot.empty()) {
        if (is_new && !present.contains({one->cell(), ""})) {
          Record record = head_of(experiment, *one);
          record["status"] = "skipped", record["reason"] = own.cannot;
          records.append(record);
        }
        continue;
      }
      benchmark::ClearRegisteredBenchmarks();
      benchmark::RegisterBenchmark(one->cell().c_str(),
                                   [one](benchmark::State& state) { run_case(state, *one); })
          ->Iterations(own.passes)
          ->Threads(one->is_threaded_inside ? 1 : one->threads)
          ->UseRealTime();
      Recorder recorder([&](const auto& run) {
        records.append(measured_record(experiment, *one, own, repetition, run));
      });
      benchmark::RunSpecifiedBenchmarks(&recorder);
    }
  }
  benchmark::ClearRegisteredBenchmarks();
}

} // namespace dss
