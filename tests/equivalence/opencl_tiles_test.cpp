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

/// Every program with barriers takes PoCL seconds, so only one run has all shapes.
TEST_F(OpenCl, tiles_of_any_shape_have_the_bits_of_packs) {
  each_run(packs(), [](const VariantRun& run, const State& start) {
    if (run.method.stages == 1 || run.method.has_error_stage) return;
    if (run.problem.name != "plate" && run.model != Model::axial) return;
    const bool has_all =
        run.method.name == "rk4" && run.model == Model::spatial && run.precision == Precision::f64;
    const State expected = run.after(start, 13);
    for (const char* tile : {"9x8x4", "32x8x2", "16x16x3", "30x2x1"}) {
      const DeviceAs gpu("gpu", tile);
      const VariantRun other{load_variant("opencl"), run.problem, run.method, run.model,
                             run.precision};
      EXPECT_NE(other.executor()->schedule().find("a launch, in tiles"), std::string::npos);
      EXPECT_EQ(differing_bits(expected, other.after(start, 13), run.precision), 0u) << tile;
      if (!has_all) break;
    }
  });
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
  EXPECT_EQ(differing_bits(state, run.after(start, 5), Precision::f64), 0u);
}

} // namespace
} // namespace dss::test
