#include "experiments/cli/compare_programs.hpp"
#include "experiments/base/child.hpp"
#include "experiments/base/exit_code.hpp"
#include "experiments/base/quiet.hpp"
#include "experiments/base/records.hpp"
#include "experiments/base/statistics.hpp"
#include "experiments/base/text_table.hpp"
#include "experiments/base/usage.hpp"
#include "experiments/cli/arguments.hpp"
#include "experiments/measure/patience.hpp"
#include "experiments/run/plan/context.hpp"
#include "solver/cores.hpp"
#include "solver/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <optional>
#include <random>

namespace dss {
namespace {

constexpr const char* mark = "--"; ///< between two commands
constexpr unsigned order_seed = 20261130;
/// A run is disturbed if others used more than this share of all processors, beyond what the clock
/// of /proc/stat resolves at both ends. (The threads of another program do not tell what they wait
/// for, so this is coarser than what DESIGN.md calls contaminated.)
constexpr double most_disturbed = 0.01, clock_s = 0.02;

/// What one run took [s].
struct ProgramTimes {
  double wall_s = 0, cpu_s = 0;
  double others_s = 0; ///< everything else on the machine, and the hypervisor
  bool is_disturbed() const {
    return others_s > clock_s + most_disturbed * wall_s * usable_cores();
  }
};

/// One of the programs that are timed in turn.
struct TimedProgram {
  std::string name;
  const std::vector<std::string>& words;
  std::vector<ProgramTimes> rounds; ///< the last attempt of each round
  std::vector<double> walls() const {
    std::vector<double> times;
    for (const ProgramTimes& run : rounds) times.push_back(run.wall_s);
    return times;
  }
  long disturbed() const { return std::ranges::count_if(rounds, &ProgramTimes::is_disturbed); }
};

/// @throws InputError if the program fails
ProgramTimes timed(const TimedProgram& program, double time_limit_s) {
  // env finds the program, and sets variables.
  std::vector<std::string> words{"env"};
  words.insert(words.end(), program.words.begin(), program.words.end());
  const double cpu_before_s = children_cpu_s();
  const UsageMeter meter;
  const ChildResult child = run_child("/usr/bin/env", words, time_limit_s);
  const Usage usage = meter.read();
  if (const std::string why = child.failure(time_limit_s); !why.empty())
    throw InputError(fmt::format("{} ({}): {}", program.name, fmt::join(program.words, " "), why));
  const double cpu_s = children_cpu_s() - cpu_before_s;
  const double others_s = std::isnan(usage.others_s) ? 0 : usage.others_s - cpu_s;
  return {child.wall_s, cpu_s, std::max(0.0, others_s) + usage.steal_s};
}

/// Rounds of all programs in random order; disturbed runs are repeated at the end of a round.
class ProgramRounds {
public:
  ProgramRounds(const ProgramPair& pair, Progress& progress)
      : pair_(pair), progress_(progress), patience_(pair.patience_s, progress, disturbance) {
    programs_.push_back({"A", pair.before, {}});
    programs_.push_back({"A again", pair.before, {}});
    programs_.push_back({"B", pair.after, {}});
  }

  void measure() {
    for (long round = -pair_.warmup; round < pair_.repetitions; ++round) {
      std::vector<TimedProgram*> order, disturbed;
      for (TimedProgram& program : programs_) order.push_back(&program);
      std::shuffle(order.begin(), order.end(), generator_);
      for (TimedProgram* program : order) {
        patience_.wait();
        const ProgramTimes times = timed(*program, pair_.time_limit_s);
        progress_.show(double(++runs_),
                       double(long(programs_.size()) * (pair_.warmup + pair_.repetitions)),
                       fmt::format("{}: {:.4g} s", program->name, times.wall_s));
        if (round < 0) continue;
        program->rounds.push_back(times);
        record(*program, round, 0);
        if (times.is_disturbed()) disturbed.push_back(program);
      }
      for (TimedProgram* program : disturbed) repeat(*program, round);
    }
    if (const std::string report = patience_.report(); !report.empty()) progress_.note(report);
  }

  const TimedProgram& before() const { return programs_[0]; }
  const TimedProgram& twin() const { return programs_[1]; }
  const TimedProgram& after() const { return programs_[2]; }
  const std::vector<TimedProgram>& programs() const { return programs_; }
  const Table& records() const { return records_; }

private:
  void repeat(TimedProgram& program, long round) {
    if (!patience_.allows(program.rounds.back().wall_s)) return;
    patience_.wait();
    program.rounds.back() = timed(program, pair_.time_limit_s);
    patience_.spend(program.rounds.back().wall_s);
    record(program, round, 1);
  }

  void record(const TimedProgram& program, long round, int attempt) {
    const ProgramTimes& times = program.rounds.back();
    records_.rows.push_back({{"program", program.name},
                             {"command", fmt::format("{}", fmt::join(program.words, " "))},
                             {"repetition", fmt::format("{}", round)},
                             {"attempt", fmt::format("{}", attempt)},
                             {"wall_s", number_text(times.wall_s)},
                             {"cpu_s", number_text(times.cpu_s)},
                             {"others_s", number_text(times.others_s)},
                             {"disturbed", times.is_disturbed() ? "true" : "false"}});
  }

  const ProgramPair& pair_;
  std::vector<TimedProgram> programs_;
  long runs_ = 0;
  std::mt19937_64 generator_{order_seed};
  Progress& progress_;
  Patience patience_;
  Table records_{
      {"program", "command", "repetition", "attempt", "wall_s", "cpu_s", "others_s", "disturbed"},
      {}};
};

Estimate ratio_of(const TimedProgram& program, const TimedProgram& base) {
  std::vector<double> ratios = program.walls();
  for (std::size_t round = 0; round < ratios.size(); ++round)
    ratios[round] /= base.rounds[round].wall_s;
  return estimate(ratios);
}

/// What the times say.
struct PairVerdict {
  Estimate ratio;          ///< of B's time to A's
  double resolution = 0;   ///< smallest difference that counts: what equal programs differ by
  std::optional<double> p; ///< of the rank-sum test, which needs 9 repetitions
  bool differs() const {
    const Interval& interval = *ratio.interval;
    return (interval.low > 1 || interval.high < 1) && std::abs(ratio.median - 1) > resolution &&
           p.value_or(0) < 0.05;
  }
  bool is_slower() const { return differs() && ratio.median > 1; }
  std::string sentence() const {
    const std::string factor = fmt::format("{:.4g} [{:.4g}, {:.4g}]", ratio.median,
                                           ratio.interval->low, ratio.interval->high);
    if (!differs())
      return fmt::format("no difference beyond the resolution of {:.2g} %: B takes {} times as "
                         "long as A",
                         100 * resolution, factor);
    return fmt::format("B is {}: it takes {} times as long as A (resolution {:.2g} %)",
                       is_slower() ? "slower" : "faster", factor, 100 * resolution);
  }
};

PairVerdict judged(const ProgramRounds& rounds) {
  const Interval equal = *ratio_of(rounds.twin(), rounds.before()).interval;
  PairVerdict verdict{
      ratio_of(rounds.after(), rounds.before()), std::max(equal.high - 1, 1 - equal.low), {}};
  if (rounds.before().rounds.size() >= rank_sum_samples)
    verdict.p = rank_sum_p_value(rounds.before().walls(), rounds.after().walls());
  return verdict;
}

std::vector<std::string> row_of(const TimedProgram& program) {
  const Estimate wall = estimate(program.walls());
  std::vector<double> cpu;
  for (const ProgramTimes& run : program.rounds) cpu.push_back(run.cpu_s);
  return {program.name,
          fmt::format("{:.4g}", wall.median),
          fmt::format("[{:.4g}, {:.4g}]", wall.interval->low, wall.interval->high),
          fmt::format("{:.4g}", median(cpu)),
          fmt::format("{} of {}", program.disturbed(), wall.count),
          fmt::format("{}", fmt::join(program.words, " "))};
}

const std::vector<std::string> head = {"program", "median [s]", "95 % interval",
                                       "CPU [s]", "disturbed",  "command"};

std::string markdown_of(const ProgramRounds& rounds, const PairVerdict& verdict) {
  std::string text = fmt::format("| {} |\n|{}\n", fmt::join(head, " | "),
                                 fmt::join(std::vector<std::string>(head.size(), "---|"), ""));
  for (const TimedProgram& program : rounds.programs()) {
    std::vector<std::string> row = row_of(program);
    for (std::string& cell : row)
      for (std::size_t bar = cell.find('|'); bar != std::string::npos;
           bar = cell.find('|', bar + 2))
        cell.insert(bar, 1, '\\');
    text += fmt::format("| {} |\n", fmt::join(row, " | "));
  }
  return text + fmt::format("\nVerdict: {}.\n", verdict.sentence());
}

nlohmann::ordered_json json_of(const ProgramRounds& rounds, const PairVerdict& verdict) {
  nlohmann::ordered_json programs = nlohmann::ordered_json::array();
  for (const TimedProgram& program : rounds.programs()) {
    const Estimate wall = estimate(program.walls());
    programs.push_back({{"name", program.name},
                        {"command", program.words},
                        {"repetitions", wall.count},
                        {"disturbed", program.disturbed()},
                        {"wall_s", wall.median},
                        {"wall_low_s", wall.interval->low},
                        {"wall_high_s", wall.interval->high}});
  }
  return {{"programs", programs},
          {"ratio", verdict.ratio.median},
          {"ratio_low", verdict.ratio.interval->low},
          {"ratio_high", verdict.ratio.interval->high},
          {"resolution", verdict.resolution},
          {"rank_sum_p", verdict.p ? nlohmann::ordered_json(*verdict.p) : nlohmann::ordered_json()},
          {"verdict", verdict.sentence()},
          {"context", measurement_context()}};
}

} // namespace

void split_commands(const std::vector<std::string>& words, ProgramPair& pair) {
  const auto first = std::ranges::find(words, mark);
  pair.before.assign(words.begin(), first);
  pair.after.assign(first == words.end() ? first : first + 1, words.end());
  if (pair.before.empty() || pair.after.empty() ||
      std::ranges::find(pair.after, mark) != pair.after.end())
    throw InputError("compare: takes two commands, dssbench compare -- A... -- B...; words of a "
                     "command that are \"--\" themselves need sh -c");
}

int compare_programs(const ProgramPair& pair) {
  for (const std::string& file : {pair.json, pair.csv, pair.markdown})
    if (!file.empty() && file != "-") require_writable(file);
  auto progress = std::make_unique<Progress>();
  ProgramRounds rounds(pair, *progress);
  rounds.measure();
  progress.reset(); // the table begins on a line of its own
  const PairVerdict verdict = judged(rounds);
  FileSet outputs;
  if (!pair.csv.empty()) outputs.open(pair.csv).write(csv_text(rounds.records()));
  if (!pair.markdown.empty()) outputs.open(pair.markdown).write(markdown_of(rounds, verdict));
  write_json(outputs, pair.json, json_of(rounds, verdict));
  if (pair.json != "-") {
    std::vector<std::vector<std::string>> rows;
    for (const TimedProgram& program : rounds.programs()) rows.push_back(row_of(program));
    fmt::print("{}{}.\n", text_table(head, rows), verdict.sentence());
  }
  return verdict.is_slower() ? exit_check_failed : exit_success;
}

} // namespace dss
