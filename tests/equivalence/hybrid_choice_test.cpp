/// Which members a hybrid has: as asked, for tests, or by trials.
#include "solver/error.hpp"
#include "tests/equivalence/hybrid_run.hpp"
#include "variants/hybrid/choice.hpp"
#include "variants/hybrid/hybrid.hpp"

namespace dss::test {
namespace {

TEST_F(Hybrid, takes_the_members_of_its_setup_or_its_own) {
  const Problem problem = fixture::make_plate(12);
  const Method& method = methods().front();
  const State start = fixture::random_state(problem, 11, 1e-4, 0.02, 0.01);
  const State whole = VariantRun{plugin_of("avx512"), problem, method}.after(start, 30);
  for (const char* members : {"", "auto", "avx2:1", "avx2:1,avx512:1"})
    for (const int threads : {1, 2, 3, 7}) {
      dss::Setup setup{problem, method, Model::spatial, Precision::f64, problem.dt, threads};
      setup.members = here(members);
      const auto run = create_hybrid(setup);
      run->write(0, start);
      run->advance(30, signal_rows(problem, method, problem.dt, 0, 30));
      State result = poisoned(problem);
      run->read(0, result);
      EXPECT_EQ(differing_bits(whole, result, Precision::f64), 0u) << members << ' ' << threads;
      const HybridInfo info = hybrid_info(*run);
      double share = 0;
      for (const auto& entry : info.members) share += entry.share;
      EXPECT_NEAR(share, 1, 1e-12) << members;
      EXPECT_EQ(info.members.size(),
                setup.members.empty() || setup.members.find(',') != std::string::npos ? 2u : 1u)
          << members;
      EXPECT_EQ(info.reason.empty(), setup.members != "auto") << members;
    }
}

TEST_F(Hybrid, has_no_more_members_than_rows) {
  const Problem problem = fixture::make_block(9, 2, 1, LinkLaw::paper),
                row = fixture::make_block(9, 1, 1, LinkLaw::paper);
  const auto members_on = [](const Problem& on) {
    dss::Setup setup{on, methods().front(), Model::spatial, Precision::f64, on.dt};
    setup.members = here("avx512:1,avx2:1,avx2:1");
    const auto run = create_hybrid(setup);
    run->advance(5, signal_rows(on, methods().front(), on.dt, 0, 5));
    return hybrid_info(*run).members.size();
  };
  EXPECT_EQ(members_on(problem), 2u);
  EXPECT_EQ(members_on(row), 1u);
}

TEST_F(Hybrid, refuses_members_that_compute_no_parts_or_round_otherwise) {
  const Problem problem = fixture::make_plate(12);
  const auto refusal = [&](const char* members) -> std::string {
    dss::Setup setup{problem, methods().front(), Model::spatial, Precision::f64, problem.dt};
    setup.members = here(members);
    try {
      create_hybrid(setup);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refusal("avx2:1,hybrid:1").find("hybrid has parts of its own"), std::string::npos);
  EXPECT_NE(refusal("avx2:1,avx3:1").find("\"avx3\" does not exist"), std::string::npos);
  if (has("reference")) {
    EXPECT_NE(refusal("avx2:1,reference:1").find("reference rounds otherwise"), std::string::npos);
    const dss::Setup setup{problem, methods().front(), Model::spatial, Precision::f64, problem.dt};
    const std::vector<Participant> members = {{{"avx2", "", 1}, &load_variant("avx2")},
                                              {{"reference", "", 1}, &load_variant("reference")}};
    EXPECT_THROW(make_executor(setup, members), InputError);
  }
}

/// A run of the executor that an automatic choice leaves, from a state that is written first.
State after_choice(const Choice& choice, const dss::Setup& setup, const State& start) {
  const auto made = choice.executor ? nullptr : make_executor(setup, choice.participants);
  Executor& run = choice.executor ? *choice.executor : *made;
  run.write(0, start);
  run.advance(30, signal_rows(setup.problem, setup.method, setup.dt, 0, 30));
  State result = poisoned(setup.problem);
  run.read(0, result);
  return result;
}

TEST_F(Hybrid, auto_tries_devices_that_may_pay_and_leaves_out_those_that_cannot) {
  const Problem problem = fixture::make_plate(150);
  const Method& method = methods().front();
  const State start = fixture::random_state(problem, 12, 1e-4, 0.02, 0.01);
  const State whole = VariantRun{plugin_of("avx512"), problem, method}.after(start, 30);
  const dss::Setup setup{problem, method, Model::spatial, Precision::f64, problem.dt, 1};
  const Choice equals = choose_fastest(setup, {{{"avx2", "as fast", 1}, &load_variant("avx2")}});
  EXPECT_NE(equals.reason.find("tried: "), std::string::npos) << equals.reason;
  EXPECT_EQ(differing_bits(whole, after_choice(equals, setup, start), Precision::f64), 0u);
  if (!has("reference")) return;
  const Choice unlike =
      choose_fastest(setup, {{{"reference", "slow", 1}, &load_variant("reference")}});
  ASSERT_EQ(unlike.participants.size(), 1u) << unlike.reason;
  EXPECT_EQ(unlike.participants[0].member.device, "");
  EXPECT_EQ(differing_bits(whole, after_choice(unlike, setup, start), Precision::f64), 0u);
}

/// tests/cli tests more ranks.
TEST_F(Hybrid, gives_members_to_ranks) {
  if (!has("mpi")) GTEST_SKIP() << "no mpi";
  const Problem problem = fixture::make_plate(12);
  const Method& method = methods().front();
  dss::Setup setup{problem, method, Model::spatial, Precision::f64, problem.dt};
  setup.members = here("avx2:2,avx512:1");
  const auto run = load_variant("mpi").create(setup);
  EXPECT_EQ(rank_info(*run).variant, "avx2");
  EXPECT_EQ(rank_info(*run).halo, "deep");
  EXPECT_EQ(run->workers(), 2);
  const State start = fixture::random_state(problem, 11, 1e-4, 0.02, 0.01);
  run->write(0, start);
  run->advance(30, signal_rows(problem, method, problem.dt, 0, 30));
  State result = poisoned(problem);
  run->read(0, result);
  const State whole = VariantRun{plugin_of("avx512"), problem, method}.after(start, 30);
  EXPECT_EQ(differing_bits(whole, result, Precision::f64), 0u);
  setup.members = "auto";
  EXPECT_THROW(load_variant("mpi").create(setup), InputError);
}

} // namespace
} // namespace dss::test
