/// Every variant against the oracle and against each other. One parametrised test runs over the
/// registry, so a new variant is tested because it exists. Problems are built in code and cover
/// every term. `dssbench verify` covers the shipped scenes.
#include "tests/equivalence/comparison.hpp"
#include "tests/fixtures/problems.hpp"
#include "variants/engine/kernel_set.hpp"

#include <gtest/gtest.h>

#include <map>
#include <tuple>

namespace dss::test {
namespace {

/// The two most common models, with every method.
bool is_common(Model model) { return model == Model::spatial || model == Model::planar; }

struct Case {
  std::string name;
  Problem problem;
  bool is_flat = false; ///< one element thick, all extra links in the plane
  double gap = 0.02;    ///< of random states, for the size of the problem's elements [m]
  bool is_bar = false;  ///< linked along x only, for the axial model
  bool is_bent =
      false; ///< flat, with loads across the plane; finite rotations would feel them within it

  /// Whether the equations of a model are those of a larger one without the missing parts. Linear
  /// equations split into those of a bar, of bending and of the plane.
  bool has(Model model) const {
    if (!is_built(model)) return false;
    if (problem.has_rotating_frame() || problem.has_mass_ratios()) return model == Model::spatial;
    if (is_bar || model == Model::axial) return is_bar && model == Model::axial;
    return is_flat || degrees_of(model) == dof_all || (is_bent && model == Model::bending);
  }
};

std::vector<Case> cases() {
  std::vector<Case> all{
      {"plate", fixture::make_plate(12), true, 1e-3},
      {"everything", fixture::make_everything()},
      {"flat_everything", fixture::make_flat_everything(), true},
      {"across_the_plane", fixture::make_flat_everything(true), false, 0.02, false, true},
      {"pair", fixture::make_pair(LinkLaw::paper)},
      {"damped_joint", fixture::make_damped_joint()},
      {"sponge", fixture::make_sponge(21, 6, 5, LinkLaw::paper, 1)},
      {"material_sponge", fixture::make_sponge(13, 7, 3, LinkLaw::material, 2)},
      {"comb", fixture::make_comb(97, 3, 2, LinkLaw::paper)},
      {"flat_comb", fixture::make_comb(47, 5, 1, LinkLaw::material), true},
      {"flat_sponge", fixture::make_sponge(37, 9, 1, LinkLaw::paper, 3), true},
      {"tumbling_box", fixture::make_tumbling_box(1)},
      {"pressed_sponge", fixture::make_pressed_sponge(13, 6, 5)},
      {"undamped_pressed_sponge", fixture::make_pressed_sponge(13, 6, 5, 0)},
      {"pressed_plate", fixture::make_pressed_plate(19, 7), true},
      {"pressed_pair", fixture::make_pressed_pair(19, 7), true},
      {"pressed_everything", fixture::pressed(fixture::make_everything())},
      {"pressed_flat_everything", fixture::pressed(fixture::make_flat_everything()), true},
      {"pressed_comb", fixture::pressed(fixture::make_comb(47, 3, 2, LinkLaw::material))},
      {"rotating_pressed", fixture::rotating(fixture::pressed(fixture::make_everything()))},
      {"masses", fixture::of_masses(fixture::pressed(fixture::make_everything()))},
      {"rotating_masses",
       fixture::of_masses(fixture::rotating(fixture::make_sponge(7, 6, 5, LinkLaw::paper, 4)))},
      {"rotating_sponge", fixture::rotating(fixture::make_sponge(21, 6, 5, LinkLaw::material, 4))},
      {"bar", fixture::make_block(37, 1, 1, LinkLaw::paper), false, 0.02, true},
      {"undamped_bar", fixture::make_block(21, 1, 1, LinkLaw::material, 0), false, 0.02, true}};
  for (const LinkLaw law : {LinkLaw::paper, LinkLaw::material}) {
    const std::string suffix = law == LinkLaw::paper ? "_paper" : "_material";
    all.push_back({"rotating" + suffix, fixture::rotating(fixture::make_block(5, 4, 3, law))});
    all.push_back({"undamped" + suffix, fixture::make_block(5, 4, 3, law, 0)});
    all.push_back({"sheet" + suffix, fixture::make_block(19, 6, 1, law), true});
    all.push_back({"lean_sheet" + suffix, fixture::make_lean_sheet(19, 6, law), true});
    for (const int n : {1, 2, 3, 4, 5, 7, 8, 9, 15, 16, 17,
                        31}) // awkward sizes: near the lanes of every variant, and primes
      all.push_back(
          {"row_of_" + std::to_string(n) + suffix, fixture::make_block(n, 2, n < 6 ? n : 1, law)});
  }
  return all;
}

bool is_row_for_all(const Case& c) {
  return c.name == "row_of_1_paper" || c.name == "row_of_7_material" ||
         c.name == "row_of_16_paper" || c.name == "row_of_17_material";
}

/// Every method runs in common models, but for rows of awkward sizes: these are about lanes, and a
/// method is about row actions and coefficients.
std::vector<Scheme> schemes_of(const Case& c, Model model) {
  return is_common(model) && !c.name.starts_with("row_of") ? schemes() : brief_schemes();
}

/// A variant, and which cases it runs.
struct TestedVariant {
  const Plugin& plugin;

  /// Rows of awkward sizes run in the two common models. So do all problems on devices and in
  /// hybrids, because devices compile each model of each problem. Variants that compute by others
  /// take a few of these rows: one element, and packs that are full, one short, one over.
  std::vector<Model> tested_models(const Case& c) const {
    if (missing_term(plugin, c.problem) != nullptr) return {};
    const bool is_row = c.name.starts_with("row_of");
    if (is_composed(plugin) && ((is_row && !is_row_for_all(c)) || !is_for_joined(c))) return {};
    // Another description of finite rotations: the rest is the code of the same oracle.
    if (plugin.rotation != Rotation::quaternion)
      return is_row || !c.has(Model::spatial) ? std::vector<Model>{} : std::vector{Model::spatial};
    std::vector<Model> tested;
    for (const Model model : models)
      if (c.has(model) && (is_common(model) || !(is_composed(plugin) || is_row)))
        tested.push_back(model);
    return tested;
  }
  /// Hybrids, ranks and devices have tests of their own, which hold them against packs. Each case
  /// is a program that a device compiles for seconds; these have all terms, laws and shapes.
  static bool is_for_joined(const Case& c) {
    return c.name == "plate" || c.name == "everything" || c.name == "sponge" ||
           c.name == "lean_sheet_paper" || c.name == "pressed_plate" ||
           c.name == "rotating_paper" || c.name == "rotating_pressed" || c.name == "masses" ||
           c.name == "undamped_material";
  }
  /// Every pairing for the problem with all terms and, but for devices, for the paper's plate.
  /// Other problems take the first pairing. opencl_run.hpp has more pairings for devices. If forces
  /// do not depend on velocities, they also take the other family, which then holds no half-step
  /// velocities.
  std::vector<Scheme> composed_schemes(const Case& c) const {
    if (c.name == "everything" || (c.name == "plate" && plugin.devices == nullptr))
      return device_schemes();
    std::vector<Scheme> first{{*find_method("rk4"), Precision::f64}};
    if (c.name == "lean_sheet_paper")
      first.push_back({*find_method("velocity_verlet"), Precision::f64});
    return first;
  }
  std::vector<Scheme> tested_schemes(const Case& c, Model model) const {
    if (is_composed(plugin)) return composed_schemes(c);
    std::vector<Scheme> all;
    for (const Scheme& scheme : schemes_of(c, model))
      if (plugin.is_compensated || scheme.precision != Precision::f32c) all.push_back(scheme);
    return all;
  }
};

class EveryVariant : public testing::TestWithParam<std::string>, protected TestedVariant {
protected:
  EveryVariant() : TestedVariant{load_variant(GetParam())} {}
  State start(const Case& c, Model model, Precision precision, unsigned seed) const {
    return rounded(restricted(fixture::random_state(c.problem, seed, c.gap), model), precision);
  }
};

TEST_P(EveryVariant, agrees_with_the_oracle_after_one_evaluation_of_a_random_state) {
  for (const Case& c : cases())
    for (const Model model : tested_models(c))
      for (const Precision precision : {Precision::f64, Precision::f32}) {
        if (is_composed(plugin) && precision == Precision::f32 && composed_schemes(c).size() < 3)
          continue;
        const Method& method = methods().front(); // the method does not matter here
        const State state = start(c, model, precision, 1);
        const State rates =
            VariantRun{plugin, c.problem, method, model, precision}.derivative(state);
        const double error = relative_error(plugin.has_all ? restricted_rates(rates, model) : rates,
                                            oracle_derivative(c.problem, method, state, model));
        EXPECT_LE(error, precision == Precision::f64 ? 1e-13 : 1e-5)
            << c.name << ' ' << name(model) << ' ' << name(precision);
      }
}

/// One test for all variants, because the oracle's runs take longest. All precisions begin at a
/// state that float32 holds, so they have one run of the oracle.
TEST(Variants, agree_with_the_oracle_after_a_run_from_a_moderate_state) {
  for (const Case& c : cases()) {
    std::map<std::tuple<Model, std::string_view, Rotation>, State> expected;
    for (const std::string& variant : usable_variants()) {
      const TestedVariant tested{load_variant(variant)};
      for (const Model model : tested.tested_models(c))
        for (const auto& [method, precision] : tested.tested_schemes(c, model)) {
          const State state = rounded(
              restricted(fixture::random_state(c.problem, 2, c.gap * 0.01, 0.02, 0.01), model),
              Precision::f32);
          const State end =
              VariantRun{tested.plugin, c.problem, method, model, precision}.after(state, 8);
          const Rotation finite = tested.plugin.rotation;
          State& of_oracle = expected[{model, method.name, finite}];
          if (of_oracle.empty())
            of_oracle = oracle_after(c.problem, method, state, 8, model, finite);
          const bool is_whole = tested.plugin.has_all && !is_common(model);
          EXPECT_LE(relative_error(is_whole ? restricted(end, model) : end, of_oracle),
                    precision == Precision::f64 ? 1e-10 : 2e-3)
              << variant << ' ' << c.name << ' ' << name(model) << ' ' << name(precision) << ' '
              << method.name;
        }
    }
  }
}

TEST_P(EveryVariant, has_bitwise_equal_states_for_any_number_of_threads) {
  if (!plugin.is_threaded) GTEST_SKIP() << "not threaded";
  const bool is_on_device =
      is_composed(plugin); // each may make a device of its own, which takes time
  const std::vector<int> counts = is_on_device ? std::vector{2, 7} : std::vector{2, 3, 4, 7};
  for (const Case& c : cases())
    for (const auto& [method, precision] : is_on_device ? composed_schemes(c) : brief_schemes()) {
      if (is_on_device &&
          ((c.name.starts_with("row_of") && !c.name.starts_with("row_of_17")) || !is_for_joined(c)))
        continue;
      if (missing_term(plugin, c.problem) != nullptr) continue;
      const State state =
          rounded(fixture::random_state(c.problem, 3, c.gap * 0.01, 0.02, 0.01), precision);
      const State one =
          VariantRun{plugin, c.problem, method, Model::spatial, precision, 1}.after(state, 20);
      for (const int threads : counts)
        EXPECT_EQ(differing_bits(
                      one,
                      (VariantRun{plugin, c.problem, method, Model::spatial, precision, threads})
                          .after(state, 20),
                      precision),
                  0u)
            << c.name << ' ' << name(precision) << ' ' << method.name << ' ' << threads
            << " threads";
    }
}

TEST_P(EveryVariant, keeps_a_state_at_rest_at_rest_to_the_last_bit) {
  const Problem problem = fixture::make_block(9, 3, 2, LinkLaw::material);
  for (const Method& method : methods()) {
    const State rest(problem.lattice.element_count * field_count, 0.0);
    EXPECT_EQ((VariantRun{plugin, problem, method}.after(rest, 50)), rest) << method.name;
  }
}

TEST_P(EveryVariant, reports_the_step_and_element_of_the_first_non_finite_state) {
  const Problem problem = fixture::make_block(9, 3, 1, LinkLaw::paper);
  for (const Method& method : methods())
    for (const int threads : {1, 3}) {
      State state(problem.lattice.element_count * field_count, 0.0);
      state[13 * field_count + uy] = std::numeric_limits<double>::infinity();
      const auto run = plugin.create({problem, method, Model::spatial, Precision::f64, problem.dt,
                                      plugin.is_threaded ? threads : 1});
      run->write(0, state);
      const Outcome outcome = run->advance(10, signal_rows(problem, method, problem.dt, 0, 10));
      EXPECT_FALSE(outcome.is_finite) << method.name;
      EXPECT_EQ(outcome.step, 0) << method.name;
      EXPECT_LE(outcome.element, 13u + 9u)
          << method.name; // the element itself, or a neighbour that it reached within the step
      EXPECT_GE(outcome.element, 13u - 9u - 4u) << method.name;
    }
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryVariant, testing::ValuesIn(usable_variants()),
                         name_of_variant);

TEST(VariantsWithFma, have_bitwise_equal_states_per_precision) {
  std::vector<const Plugin*> fused;
  for (const std::string& variant : usable_variants())
    if (load_variant(variant).has_fma) fused.push_back(&load_variant(variant));
  if (fused.size() < 2) GTEST_SKIP() << "this CPU runs " << fused.size() << " variant(s) with FMA";
  for (const Case& c : cases())
    for (const Model model : models)
      for (const auto& [method, precision] : schemes_of(c, model)) {
        if (!c.has(model) || (!is_common(model) && c.name.starts_with("row_of"))) continue;
        const State state = rounded(
            restricted(fixture::random_state(c.problem, 4, c.gap * 0.01, 0.02, 0.01), model),
            precision);
        const State first =
            VariantRun{*fused[0], c.problem, method, model, precision}.after(state, 60);
        for (const Plugin* other : fused) {
          // Devices compile for every problem, so they run only the one with all terms. Their other
          // actions and their parts have tests of their own.
          const bool is_left_out =
              is_composed(*other) &&
              ((c.name != "plate" && c.name != "everything") || method.name != "rk4" ||
               precision == Precision::f32c || !is_common(model));
          if (other == fused[0] || is_left_out) continue;
          EXPECT_EQ(differing_bits(
                        first,
                        VariantRun{*other, c.problem, method, model, precision}.after(state, 60),
                        precision),
                    0u)
              << c.name << ' ' << name(model) << ' ' << name(precision) << ' ' << method.name << ' '
              << other->name;
        }
      }
}

} // namespace
} // namespace dss::test
