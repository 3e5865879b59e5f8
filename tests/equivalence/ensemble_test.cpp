/// Ensembles: members in the lanes of packs. Each member must have the bits of a run of its own,
/// and one that fails must not touch the others.
#include "solver/model/ensemble.hpp"
#include "tests/equivalence/comparison.hpp"
#include "tests/fixtures/problems.hpp"
#include "variants/engine/kernel_set.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace dss::test {
namespace {

/// The same topology with other numbers everywhere.
Problem varied(Problem problem, std::size_t member) {
  const double more = double(member);
  const auto scale = [](AxisConstants& c, double stiffness, double damping) {
    c.k_normal *= stiffness, c.d_normal *= damping;
    for (double& k : c.k_shear) k *= stiffness;
    for (double& d : c.d_shear) d *= damping;
    for (double& k : c.k_rot) k *= stiffness;
    for (double& d : c.d_rot) d *= damping;
  };
  for (Body& body : problem.bodies) {
    for (double& edge : body.edge) edge *= 1 + 0.02 * more;
    for (double& inertia : body.inertia) inertia *= 1 + 0.04 * more;
    body.mass *= 1 + 0.03 * more;
    for (AxisConstants& c : body.axis) scale(c, 1 + 0.1 * more, 1 + 0.2 * more);
    for (auto& kind : body.more_kinds)
      for (AxisConstants& c : kind) scale(c, 1 + 0.12 * more, 1 + 0.17 * more);
    for (ElementPressure& pressure : body.pressures) {
      pressure.volume *= 1 + 0.1 * more;
      for (double& bending : pressure.bending) bending *= 1 + 0.13 * more;
    }
  }
  for (ExtraLink& link : problem.extra_links)
    scale(link.constants, 1 + 0.15 * more, 1 + 0.1 * more);
  for (Load& load : problem.loads) {
    load.force[0] += more, load.torque[2] -= 0.01 * more;
    load.face_strain *= 1 - 0.03 * more;
    load.signal.amplitude *= 1 - 0.05 * more;
  }
  // Loads on other elements, and other clamps.
  if (member % 3 == 1 && !problem.loads.empty()) problem.loads.back().elements.front() ^= 1;
  if (member % 2 == 1 && !problem.clamps.empty()) problem.clamps.pop_back();
  for (Signal& signal : problem.frame_acceleration) signal.amplitude *= 1 + 0.1 * more;
  for (Signal& signal : problem.frame_rotation) signal.amplitude *= 1 - 0.03 * more;
  problem.stabilization.k *= 1 + 0.1 * more;
  return problem;
}

/// So many members as the lanes of a module, with states and steps of their own.
struct Members {
  std::vector<Problem> problems;
  std::vector<double> dt;
  std::vector<State> states;
  Members(const Problem& problem, std::size_t count, Model model, Precision precision) {
    for (std::size_t m = 0; m < count; ++m) {
      problems.push_back(varied(problem, m));
      dt.push_back(problem.dt * (1 - 0.01 * double(m)));
      states.push_back(rounded(
          restricted(fixture::random_state(problem, unsigned(m) + 3, 2e-4, 0.02, 0.01), model),
          precision));
    }
  }
  Ensemble ensemble() const {
    std::vector<const Problem*> all;
    for (const Problem& problem : problems) all.push_back(&problem);
    return interleave(all, dt);
  }
};

/// An ensemble on an executor.
class EnsembleOf {
public:
  EnsembleOf(const Plugin& plugin, const Members& members, const Scheme& scheme, Model model,
             int threads = 1)
      : members_(members), method_(scheme.method), ensemble_(members.ensemble()) {
    Setup setup{members.problems.front(), method_, model, scheme.precision,
                members.dt.front(),       threads};
    setup.ensemble = &ensemble_;
    executor_ = plugin.create(setup);
    State all(members.states.front().size() * lanes());
    for (std::size_t m = 0; m < lanes(); ++m)
      for (std::size_t n = 0; n < members.states[m].size(); ++n)
        all[place(m, n)] = members.states[m][n];
    executor_->write(0, all);
  }
  Outcome advance(long steps) {
    std::vector<double> all;
    for (std::size_t m = 0; m < lanes(); ++m) {
      const auto rows = signal_rows(members_.problems[m], method_, members_.dt[m], step_, steps);
      all.resize(rows.size() * lanes());
      for (std::size_t n = 0; n < rows.size(); ++n) all[n * lanes() + m] = rows[n];
    }
    step_ += steps;
    return executor_->advance(steps, all);
  }
  State state(std::size_t member) {
    State all(members_.states.front().size() * lanes()), own(members_.states.front().size());
    executor_->read(0, all);
    for (std::size_t n = 0; n < own.size(); ++n) own[n] = all[place(member, n)];
    return own;
  }
  Executor& executor() { return *executor_; }

private:
  std::size_t lanes() const { return members_.problems.size(); }
  std::size_t place(std::size_t member, std::size_t n) const {
    return (n / field_count * lanes() + member) * field_count + n % field_count;
  }
  const Members& members_;
  const Method& method_;
  const Ensemble ensemble_;
  std::unique_ptr<Executor> executor_;
  long step_ = 0;
};

class EveryEnsemble : public testing::TestWithParam<std::string> {
protected:
  const Plugin& plugin = load_variant(GetParam());
  std::size_t lanes(Precision precision) const {
    return std::size_t(plugin.ensemble_lanes(precision, {}));
  }
  void expect_bits_of_single_runs(const Problem& problem, const Scheme& scheme, Model model,
                                  std::initializer_list<int> teams = {1}) {
    const Members members(problem, lanes(scheme.precision), model, scheme.precision);
    std::vector<State> ends;
    for (std::size_t m = 0; m < members.problems.size(); ++m) {
      const VariantRun single{plugin, members.problems[m], scheme.method, model, scheme.precision,
                              1,      members.dt[m]};
      ends.push_back(single.after(members.states[m], 20));
    }
    for (const int threads : teams) {
      EnsembleOf ensemble(plugin, members, scheme, model, threads);
      EXPECT_TRUE(ensemble.advance(7).is_finite);
      EXPECT_TRUE(ensemble.advance(13).is_finite);
      for (std::size_t m = 0; m < ends.size(); ++m)
        EXPECT_EQ(differing_bits(ends[m], ensemble.state(m), scheme.precision), 0u)
            << problem.name << ", " << name(model) << ", " << name(scheme.precision) << ' '
            << scheme.method.name << ", member " << m << ", " << threads << " threads";
    }
  }
};

TEST_P(EveryEnsemble, has_the_bits_of_single_runs_in_every_method) {
  for (const Scheme& scheme : schemes()) {
    expect_bits_of_single_runs(fixture::make_everything(), scheme, Model::spatial);
    expect_bits_of_single_runs(fixture::make_sponge(5, 4, 3, LinkLaw::paper, 1), scheme,
                               Model::spatial);
    expect_bits_of_single_runs(fixture::make_pressed_sponge(5, 4, 3), scheme, Model::spatial);
    expect_bits_of_single_runs(fixture::make_pressed_pair(5, 4), scheme, Model::spatial);
    expect_bits_of_single_runs(fixture::of_masses(fixture::make_everything()), scheme,
                               Model::spatial);
    expect_bits_of_single_runs(fixture::rotating(fixture::make_everything()), scheme,
                               Model::spatial);
  }
}

TEST_P(EveryEnsemble, has_the_bits_of_single_runs_in_every_model) {
  for (const Scheme& scheme : brief_schemes())
    for (const Model model : models) {
      if (!is_built(model)) continue;
      if (model == Model::axial) {
        for (const LinkLaw law : {LinkLaw::paper, LinkLaw::material})
          expect_bits_of_single_runs(fixture::make_bars(3, 4, law), scheme, model);
        continue;
      }
      expect_bits_of_single_runs(fixture::make_flat_everything(model == Model::bending), scheme,
                                 model);
      expect_bits_of_single_runs(fixture::make_plate(6), scheme, model);
      expect_bits_of_single_runs(
          fixture::pressed(fixture::make_flat_everything(model == Model::bending)), scheme, model);
      if (descriptor(model).axes < 3) continue;
      for (const LinkLaw law : {LinkLaw::paper, LinkLaw::material})
        expect_bits_of_single_runs(fixture::make_block(4, 3, 5, law), scheme, model);
    }
}

TEST_P(EveryEnsemble, has_the_same_bits_on_several_threads) {
  for (const Scheme& scheme : brief_schemes()) {
    expect_bits_of_single_runs(fixture::make_block(3, 140, 1, LinkLaw::paper), scheme,
                               Model::spatial, {2, 3});
    expect_bits_of_single_runs(fixture::make_block(3, 4, 20, LinkLaw::material), scheme,
                               Model::spatial, {2, 3});
    expect_bits_of_single_runs(fixture::make_pressed_plate(3, 140), scheme, Model::spatial, {2, 3});
  }
}

constexpr long failing_steps = 40; ///< in which members fail that are far above their limits

/// How a single run of failing_steps ends.
struct SingleRun {
  Outcome outcome;
  State end;
};

SingleRun single_run(const VariantRun& run, const State& start) {
  const auto executor = run.executor();
  executor->write(0, start);
  SingleRun single{executor->advance(failing_steps, signal_rows(run.problem, run.method, run.dt, 0,
                                                                failing_steps)),
                   start};
  executor->read(0, single.end);
  return single;
}

TEST_P(EveryEnsemble, ends_a_member_that_fails_alone) {
  const Problem problem = fixture::make_block(4, 30, 2, LinkLaw::paper);
  for (const Scheme& scheme : brief_schemes()) {
    Members members(problem, lanes(scheme.precision), Model::spatial, scheme.precision);
    members.dt[1] = 0.5, members.dt[3] = 0.1; // far above their limits
    std::vector<SingleRun> singles;
    for (std::size_t m = 0; m < members.problems.size(); ++m) {
      singles.push_back(single_run({plugin, members.problems[m], scheme.method, Model::spatial,
                                    scheme.precision, 1, members.dt[m]},
                                   members.states[m]));
      EXPECT_EQ(singles[m].outcome.is_finite, m != 1 && m != 3);
    }
    for (const int threads : {1, 2}) {
      EnsembleOf ensemble(plugin, members, scheme, Model::spatial, threads);
      EXPECT_TRUE(ensemble.advance(failing_steps).is_finite);
      const auto outcomes = ensemble.executor().member_outcomes()->outcomes();
      for (std::size_t m = 0; m < singles.size(); ++m) {
        const auto& [expected, end] = singles[m];
        EXPECT_EQ(outcomes[m].is_finite, expected.is_finite);
        EXPECT_EQ(outcomes[m].step, expected.step);
        EXPECT_EQ(outcomes[m].element, expected.element)
            << scheme.method.name << ", member " << m << ", " << threads << " threads";
        if (expected.is_finite) {
          EXPECT_EQ(differing_bits(end, ensemble.state(m), scheme.precision), 0u);
        }
      }
      EXPECT_TRUE(ensemble.advance(10).is_finite);
      EXPECT_FALSE(ensemble.executor().member_outcomes()->outcomes()[1].is_finite);
    }
  }
}

/// Other variants compute members one after another.
std::vector<std::string> variants_with_lanes() {
  std::vector<std::string> names = usable_variants();
  std::erase_if(names, [](const std::string& name) {
    const Plugin& plugin = load_variant(name);
    return plugin.ensemble_lanes == nullptr || plugin.ensemble_lanes(Precision::f64, {}) == 1;
  });
  return names;
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(EveryEnsemble);
INSTANTIATE_TEST_SUITE_P(Variants, EveryEnsemble, testing::ValuesIn(variants_with_lanes()),
                         name_of_variant);

TEST(Ensemble, says_how_the_topology_of_a_problem_differs) {
  const Problem one = fixture::make_everything();
  EXPECT_EQ(why_other_topology(one, varied(one, 3)), "");
  Problem other = one;
  other.extra_links.pop_back();
  EXPECT_NE(why_other_topology(one, other).find("extra links"), std::string::npos);
  other = one;
  other.bodies[0].law = other.bodies[0].law == LinkLaw::paper ? LinkLaw::material : LinkLaw::paper;
  EXPECT_NE(why_other_topology(one, other).find("another law"), std::string::npos);
  EXPECT_NE(why_other_topology(one, fixture::make_plate(4)), "");
  EXPECT_NE(why_other_topology(fixture::make_block(4, 3, 2, LinkLaw::paper),
                               fixture::make_block(3, 4, 2, LinkLaw::paper)),
            "");
}

TEST(Ensemble, joins_elements_of_a_member_alone) {
  const Problem problem = fixture::make_sponge(5, 4, 3, LinkLaw::paper, 1);
  const Ensemble ensemble = interleave({&problem, &problem, &problem}, {1, 1, 1});
  std::vector<std::array<std::size_t, 3>> expected, links;
  problem.lattice.for_each_link([&](std::size_t i, std::size_t j, int axis) {
    for (std::size_t m = 0; m < 3; ++m)
      expected.push_back({i * 3 + m, j * 3 + m, std::size_t(axis)});
  });
  ensemble.lattice.for_each_link([&](std::size_t i, std::size_t j, int axis) {
    links.push_back({i, j, std::size_t(axis)});
  });
  std::ranges::sort(expected);
  std::ranges::sort(links);
  EXPECT_EQ(links, expected);
}

} // namespace
} // namespace dss::test
