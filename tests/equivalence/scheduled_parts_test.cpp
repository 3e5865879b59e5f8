/// Parts of a body under schedules that a number decides: the same bits as the whole in each order
/// of turns, no deadlock, and no message over an unread one. If a part dies, executors pass the
/// error of the halo on, so that all end. Exchanges of ranks and hybrids have tests of their own.
/// DSS_SCHEDULES is the number of schedules, DSS_SCHEDULE the first (HACKING.md).
#include "solver/decomposition/decomposition.hpp"
#include "tests/equivalence/comparison.hpp"
#include "tests/equivalence/fibres.hpp"
#include "tests/equivalence/local_halo.hpp"
#include "tests/fixtures/problems.hpp"

#include <cstdlib>
#include <gtest/gtest.h>
#include <map>
#include <optional>
#include <string>

namespace dss::test {
namespace {

/// A part that died, or whose neighbour did.
struct Death : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Letters between fibres. As in exchanges of ranks and hybrids, two slots are used in turn, so
/// that a third letter must not be sent before the first is read.
class FibreMailboxes final : public Mailboxes {
public:
  explicit FibreMailboxes(Fibres& fibres) : fibres_(fibres) {}
  void kill(int part) { dead_.push_back(part); }
  bool is_dead(int part) const { return std::ranges::count(dead_, part) > 0; }
  void put(int from, int to, Letter letter) override {
    std::deque<Letter>& box = boxes_[{from, to}];
    if (box.size() == 2) throw std::logic_error("a letter was sent over an unread one");
    box.push_back(std::move(letter));
    fibres_.wait([] { return true; });
  }
  Letter take(int from, int to) override {
    std::deque<Letter>& box = boxes_[{from, to}];
    fibres_.wait([&] { return !box.empty() || is_dead(from); });
    if (box.empty()) throw Death("a neighbour died");
    Letter letter = std::move(box.front());
    box.pop_front();
    return letter;
  }

private:
  Fibres& fibres_;
  std::vector<int> dead_;
  std::map<std::pair<int, int>, std::deque<Letter>> boxes_;
};

/// A halo whose part dies before an exchange.
class MortalHalo final : public Halo {
public:
  MortalHalo(Halo& halo, std::optional<int> last_receive) : halo_(halo), left_(last_receive) {}
  void send(Side side, int copy) override { halo_.send(side, copy); }
  void receive(Side side, int copy) override {
    if (left_ && (*left_)-- == 0) throw Death("this part dies");
    halo_.receive(side, copy);
  }

private:
  Halo& halo_;
  std::optional<int> left_;
};

struct DeathAt {
  int part, receive;
};

/// All that a number decides.
struct ScheduledRun {
  explicit ScheduledRun(std::uint64_t number) : random(number) {
    const auto one_of = [&](auto&& list) { return list[random() % std::size(list)]; };
    const char* names[] = {"scalar", "avx2", "avx512", "neon"}; // also where some are missing
    variant = one_of(names);
    problem = made(int(random() % 6));
    method = &methods()[random() % methods().size()];
    precision = one_of(precisions);
    parts = 2 + int(random() % 5);
    way = one_of(usable_ways());
    is_every_stage = random() % 2, is_overlapped = random() % 2;
    steps = 2 + long(random() % 8);
    if (random() % 4 == 0) death = {int(random() % std::uint64_t(parts)), int(random() % 12)};
  }
  static std::vector<std::string> usable_ways() {
    std::vector<std::string> ways;
    for (const std::string_view way : decomposition_methods())
      if (why_no_decomposition(way).empty()) ways.emplace_back(way);
    return ways;
  }
  static Problem made(int which) {
    switch (which) {
    case 0:
      return fixture::make_plate(14);
    case 1:
      return fixture::make_everything();
    case 2:
      return fixture::make_sponge(21, 9, 7, LinkLaw::paper, 1);
    case 3:
      return fixture::make_sponge(37, 13, 1, LinkLaw::material, 3);
    case 4:
      return fixture::make_block(6, 11, 13, LinkLaw::material, 0);
    case 5:
      return fixture::make_pressed_sponge(13, 9, 7);
    default:
      return fixture::make_damped_joint();
    }
  }
  std::string text() const {
    return variant + ' ' + problem.name + ' ' + std::string(method->name) + ' ' +
           std::string(name(precision)) + ", " + std::to_string(parts) + ' ' + way +
           (is_every_stage ? ", every stage" : "") + (is_overlapped ? ", overlapped" : "") +
           (death ? ", a part dies" : "");
  }

  std::mt19937_64 random;
  std::string variant, way;
  Problem problem;
  const Method* method = nullptr;
  Precision precision = Precision::f64;
  int parts = 2;
  bool is_every_stage = false, is_overlapped = false;
  long steps = 1;
  std::optional<DeathAt> death;
};

/// One part with what it needs, made before fibres run.
struct ScheduledPart {
  ScheduledPart(const ScheduledRun& run, const Decomposition& decomposition, int index,
                FibreMailboxes& mailboxes)
      : part(make_part(run.problem, decomposition, index,
                       StepSweeps(*run.method, run.problem).halo(run.is_every_stage))),
        local(part, mailboxes, false),
        halo(local, run.death && run.death->part == index ? std::optional(run.death->receive)
                                                          : std::nullopt),
        setup{part, halo, run.is_every_stage, run.is_overlapped},
        executor(load_variant(run.variant)
                     .create({part.problem, *run.method, Model::spatial, run.precision,
                              run.problem.dt, 1, &setup})) {}
  Part part;
  LocalHalo local;
  MortalHalo halo;
  PartSetup setup;
  std::unique_ptr<Executor> executor;
};

/// @return the state, or empty if a part died
std::optional<State> after(ScheduledRun& run, const State& start) {
  Fibres fibres(run.random());
  FibreMailboxes mailboxes(fibres);
  const Decomposition decomposition = decompose(run.problem, run.way, run.parts);
  std::vector<std::unique_ptr<ScheduledPart>> parts;
  int died = 0;
  State result = poisoned(run.problem);
  for (int p = 0; p < run.parts; ++p) {
    parts.push_back(std::make_unique<ScheduledPart>(run, decomposition, p, mailboxes));
    fibres.add([&, p] {
      Executor& executor = *parts[std::size_t(p)]->executor;
      const Part& part = parts[std::size_t(p)]->part;
      try {
        parts[std::size_t(p)]->local.attach(executor, run.precision);
        for (const Run& piece : part.runs)
          executor.write(piece.local, std::span(start).subspan(piece.global * field_count,
                                                               piece.count * field_count));
        executor.advance(run.steps,
                         signal_rows(run.problem, *run.method, run.problem.dt, 0, run.steps));
        State own = poisoned(part.problem);
        executor.read(0, own); // parts of leapfrogs exchange halos for this, too
        for (const Run& piece : part.runs)
          std::copy_n(&own[piece.local * field_count], piece.count * field_count,
                      &result[piece.global * field_count]);
      } catch (const Death&) {
        mailboxes.kill(p);
        ++died;
      }
    });
  }
  fibres.run();
  return died > 0 ? std::nullopt : std::optional(result);
}

std::uint64_t number_of(const char* variable, std::uint64_t otherwise) {
  const char* text = std::getenv(variable);
  return text == nullptr ? otherwise : std::stoull(text);
}

TEST(ScheduledParts, have_the_bits_of_the_whole_in_every_order_of_turns) {
  const std::uint64_t first = number_of("DSS_SCHEDULE", 1), count = number_of("DSS_SCHEDULES", 300);
  int deaths = 0;
  for (std::uint64_t number = first; number < first + count && !HasFailure(); ++number) {
    ScheduledRun run(number);
    SCOPED_TRACE("DSS_SCHEDULE=" + std::to_string(number) + ": " + run.text());
    if (!has(run.variant)) continue;
    if (run.way == "strips" && std::size_t(run.parts) > run.problem.lattice.rows.size()) continue;
    const State start = rounded(
        fixture::random_state(run.problem, int(number % 1000), 1e-4, 0.02, 0.01), run.precision);
    const std::optional<State> of_parts = after(run, start);
    if (!of_parts) {
      ++deaths;
      EXPECT_TRUE(run.death);
      continue;
    }
    const State whole = VariantRun{load_variant(run.variant), run.problem, *run.method,
                                   Model::spatial, run.precision}
                            .after(start, run.steps);
    EXPECT_EQ(differing_bits(whole, *of_parts, run.precision), 0u);
  }
  if (count >= 100) {
    EXPECT_GT(deaths, 0);
  }
}

TEST(Fibres, find_a_deadlock_and_repeat_themselves) {
  const auto order = [](std::uint64_t seed) {
    Fibres fibres(seed);
    std::string turns;
    for (const char name : {'a', 'b', 'c'})
      fibres.add([&, name] {
        for (int turn = 0; turn < 5; ++turn) {
          turns += name;
          fibres.wait([] { return true; });
        }
      });
    fibres.run();
    return turns;
  };
  EXPECT_EQ(order(1), order(1));
  EXPECT_NE(order(1), order(2));

  Fibres fibres(1);
  FibreMailboxes mailboxes(fibres);
  for (const int part : {0, 1}) // each waits for the other's letter first
    fibres.add([&, part] {
      mailboxes.take(1 - part, part);
      mailboxes.put(part, 1 - part, {});
    });
  EXPECT_THROW(fibres.run(), Deadlock);
}

} // namespace
} // namespace dss::test
