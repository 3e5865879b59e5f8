#pragma once
/// Runs on members of a hybrid. Times of steps are given, not measured, so that moves of elements
/// do not depend on the machine.
#include "tests/equivalence/comparison.hpp"
#include "tests/fixtures/problems.hpp"
#include "variants/hybrid/joint.hpp"

#include <gtest/gtest.h>

namespace dss::test {

/// Members in which avx512 is replaced by the widest packs of this CPU.
inline std::string here(std::string members) {
  constexpr std::string_view widest = "avx512";
  for (std::size_t at = 0; !has(widest) && (at = members.find(widest)) != std::string::npos;)
    members.replace(at, widest.size(), "avx2");
  return members;
}
inline const Plugin& plugin_of(const std::string& variant) { return load_variant(here(variant)); }

inline std::vector<Participant> participants_of(const std::string& members) {
  std::vector<Participant> participants;
  for (const Member& member : parse_members(here(members)))
    participants.push_back({member, &load_variant(member.variant)});
  return participants;
}

/// A run on members, in two calls of advance.
struct JointRun {
  const Problem& problem;
  const Method& method;
  std::string members;
  Precision precision = Precision::f64;
  StepTime step_time{};
  Model model = Model::spatial;
  double dt = problem.dt;

  std::unique_ptr<JointExecutor> executor() const {
    return std::make_unique<JointExecutor>(Setup{problem, method, model, precision, dt},
                                           participants_of(members), step_time);
  }
  State after(const State& state, long steps, int* rebalances = nullptr) const {
    const auto run = executor();
    run->write(0, state);
    const long first = steps / 3;
    run->advance(first, signal_rows(problem, method, dt, 0, first));
    run->advance(steps - first, signal_rows(problem, method, dt, first, steps - first));
    State result = poisoned(problem);
    run->read(0, result);
    if (rebalances != nullptr) *rebalances = hybrid_info(*run).rebalances;
    return result;
  }
};

/// Times of steps for members that are slow in turn: first member 0, then all others. It changes
/// every four calls a member. `slowness` is the ratio [1].
inline StepTime swinging(int members, double slowness) {
  return [members, slowness, calls = 0](std::size_t member, std::size_t elements) mutable {
    const bool is_slow = (calls++ / (4 * members)) % 2 == 0 ? member == 0 : member != 0;
    return 1.0 * double(elements) * (is_slow ? slowness : 1);
  };
}

class Hybrid : public testing::Test {
protected:
  void SetUp() override {
    if (!has("avx2")) GTEST_SKIP() << "avx2 is not here";
  }
};

} // namespace dss::test
