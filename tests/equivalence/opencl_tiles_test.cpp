/// Several stages of a GPU in one launch: the choice of a tile, and its bits.
#include "solver/error.hpp"
#include "tests/equivalence/opencl_run.hpp"
#include "variants/opencl/device.hpp"
#include "variants/opencl/stage_tile.hpp"

namespace dss::test {
namespace {

using opencl::StageTile;

/// Text of the tile that a device with 132 compute units gets.
std::string chosen(int elements_across, int rows, int stages, Precision precision) {
  opencl::Device device = opencl::find_device("", Precision::f32);
  device.compute_units = 132;
  return stages_text(opencl::choose_stage_tile(elements_across, rows, stages, precision, device));
}

TEST_F(OpenCl, tiles_are_the_smallest_whose_groups_run_side_by_side) {
  EXPECT_EQ(chosen(112, 100, 4, Precision::f64), "4 stages a launch, in tiles of 10 x 10 elements");
  EXPECT_EQ(chosen(112, 100, 4, Precision::f32), "4 stages a launch, in tiles of 10 x 10 elements");
  EXPECT_EQ(chosen(144, 140, 4, Precision::f64), "2 stages a launch, in tiles of 30 x 6 elements");
  EXPECT_EQ(chosen(208, 200, 4, Precision::f64), "2 stages a launch, in tiles of 30 x 14 elements");
  EXPECT_EQ(chosen(1008, 1000, 4, Precision::f64),
            "2 stages a launch, in tiles of 30 x 14 elements");
  EXPECT_EQ(chosen(1008, 1000, 4, Precision::f32), "stage by stage");
  EXPECT_EQ(chosen(112, 100, 2, Precision::f64), "2 stages a launch, in tiles of 14 x 14 elements");
}
TEST_F(OpenCl, tiles_do_not_serve_large_bodies_that_would_not_fill_them) {
  EXPECT_EQ(chosen(100000, 13, 4, Precision::f64), "stage by stage");
  EXPECT_EQ(chosen(16, 100000, 4, Precision::f64), "stage by stage");
}
TEST_F(OpenCl, tiles_divide_the_stages_of_a_method_evenly) {
  EXPECT_EQ(chosen(112, 100, 5, Precision::f64), "3 stages a launch, in tiles of 12 x 12 elements");
  EXPECT_EQ(chosen(112, 100, 9, Precision::f64), "3 stages a launch, in tiles of 12 x 12 elements");
  EXPECT_EQ(chosen(112, 100, 1, Precision::f64), "1 stage a launch, in tiles of 16 x 16 elements");
}

TEST_F(OpenCl, tiles_that_are_asked_for_must_have_elements_besides_their_halo) {
  for (const char* wrong : {"", "16", "16x16", "16x16x4x", "16x16x0", "6x16x4", "16x6x4", "x",
                            "-16x16x4", "9999x9999x2"}) {
    const DeviceAs gpu("gpu", wrong);
    EXPECT_THROW(chosen(112, 100, 4, Precision::f64), InputError) << wrong;
  }
  const DeviceAs gpu("gpu", "7x8x4");
  EXPECT_EQ(chosen(112, 100, 4, Precision::f64), "4 stages a launch, in tiles of 1 x 2 elements");
  EXPECT_EQ(chosen(112, 100, 2, Precision::f64), "2 stages a launch, in tiles of 5 x 6 elements");
}

/// A plate, holes, and bodies of two laws on grids of several widths, one of them upright.
std::vector<NamedProblem> flat_problems() {
  Problem bodies = fixture::make_flat_everything();
  bodies.extra_links.clear();
  fixture::add_block(bodies, fixture::second_body({3, 0, 0}), 20, 1, 7);
  return {{"plate", fixture::make_plate(19)},
          {"sponge", fixture::make_sponge(37, 9, 1, LinkLaw::material, 3)},
          {"bodies", std::move(bodies)}};
}

/// After some steps in calls of several lengths, so that either copy of the state is current.
State after_calls(const VariantRun& run, const State& start) {
  const auto executor = run.executor();
  executor->write(0, start);
  State state(start.size());
  long step = 0;
  for (const long steps : {1L, 3L, 2L, 7L}) {
    EXPECT_TRUE(executor->advance(steps, signal_rows(run.problem, run.method, run.dt, step, steps))
                    .is_finite);
    executor->read(0, state);
    step += steps;
  }
  return state;
}

/// Each program with barriers takes PoCL seconds.
TEST_F(OpenCl, tiles_of_any_shape_have_the_bits_of_packs) {
  for (const NamedProblem& c : flat_problems()) {
    const State start = fixture::random_state(c.problem, 4, 1e-4, 0.02, 0.01);
    const Method &rk4 = *find_method("rk4"), &rkc2 = *find_method("rkc2");
    std::vector<std::tuple<const Method*, Precision, const char*>> cases = {
        {&rk4, Precision::f64, "9x8x4"}, {&rkc2, Precision::f64, "9x8x3"}};
    if (c.name == "plate")
      for (const char* tile : {"32x8x2", "16x16x3", "30x2x1"})
        cases.emplace_back(&rk4, Precision::f64, tile);
    if (c.name == "bodies")
      for (const Precision precision : {Precision::f32, Precision::f32c})
        cases.emplace_back(&rkc2, precision, "9x8x4");
    for (const auto& [method, precision, tile] : cases) {
      SCOPED_TRACE(c.name + ' ' + std::string(method->name) + ' ' + tile);
      const VariantRun run{packs(), c.problem, *method, Model::spatial, precision};
      const State from = rounded(start, precision);
      const DeviceAs gpu("gpu", tile);
      const VariantRun other{load_variant("opencl"), c.problem, *method, Model::spatial, precision};
      EXPECT_NE(other.executor()->schedule().find("a launch, in tiles"), std::string::npos);
      EXPECT_EQ(differing_bits(run.after(from, 13), after_calls(other, from), precision), 0u);
    }
  }
}

/// A state is read and written between steps, when either copy may hold it.
TEST_F(OpenCl, tiles_keep_the_state_that_is_written_between_steps) {
  const DeviceAs gpu("gpu", "9x8x4");
  const Problem problem = fixture::make_plate(19);
  const VariantRun run{load_variant("opencl"), problem, *find_method("rk4")};
  const State start = fixture::random_state(problem, 4, 1e-4, 0.02, 0.01);
  const auto executor = run.executor();
  State state = start;
  for (long n = 0; n < 5; ++n) {
    executor->write(0, state);
    EXPECT_TRUE(executor->advance(1, signal_rows(problem, run.method, run.dt, n, 1)).is_finite);
    executor->read(0, state);
  }
  EXPECT_EQ(differing_bits(state, VariantRun{packs(), problem, run.method}.after(start, 5),
                           Precision::f64),
            0u);
}

} // namespace
} // namespace dss::test
