/// Microbenchmarks: what is timed is correct, what is counted is what runs, and an interrupted run
/// can go on.
#include "experiments/measure/ceilings/executed_mix.hpp"
#include "experiments/measure/ceilings/own_ceilings.hpp"
#include "experiments/measure/kernels/kernel_error.hpp"
#include "experiments/measure/kernels/kernel_work.hpp"
#include "experiments/measure/kernels/micro_run.hpp"
#include "experiments/studies/kernels/micro_tables.hpp"
#include "solver/error.hpp"
#include "solver/io/atomic_file.hpp"
#include "tests/fixtures/own_directory.hpp"
#include "variants/isa/instruction_set.hpp"
#include "variants/loading/loader.hpp"

#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <set>

namespace dss {
namespace {

using Microbenchmarks = test::OwnDirectory;

std::vector<const Plugin*> plugins_with_kernels() {
  std::vector<const Plugin*> list;
  for (const VariantStatus& variant : variants())
    if (variant.is_usable() && load_variant(variant.name).kernels != nullptr)
      list.push_back(&load_variant(variant.name));
  return list;
}

TEST_F(Microbenchmarks, EveryKernelAndRowOfEveryVariantAgreesWithLongDouble) {
  for (const Plugin* plugin : plugins_with_kernels())
    for (const CompiledKernel& kernel : plugin->kernels())
      EXPECT_LE(kernel_error(kernel), kernel_case(*plugin, kernel, "L1", 1).tolerance())
          << plugin->name << ' ' << kernel.name << ' ' << name(kernel.model) << ' '
          << name(kernel.precision);
}

TEST_F(Microbenchmarks, AKernelWithOneWrongLaneIsCaught) {
  CompiledKernel wrong = load_variant("scalar").kernels()[0];
  static const CompiledKernel right = wrong;
  wrong.run = [](int kernel, const void* in, void* out, std::size_t elements, std::size_t stride) {
    right.run(kernel, in, out, elements, stride);
    static_cast<double*>(out)[elements - 1] += 1e-9;
  };
  EXPECT_GT(kernel_error(wrong), 1e-10);
}

/// The compiler chooses how many instructions a row takes. This test only asserts that all kinds
/// are found. A counting number type counts the declared flops of rows
/// (tests/equivalence/kernel_case_test.cpp).
TEST_F(Microbenchmarks, RowsOfEveryVariantHaveAMix) {
#ifdef DSS_SANITIZED
  GTEST_SKIP() << "sanitized code executes more";
#endif
  for (const Plugin* plugin : plugins_with_kernels())
    for (const CompiledKernel& kernel : plugin->kernels()) {
      if (!kernel.is_row || kernel.model != Model::planar) continue;
      InstructionMix mix;
      try {
        mix = executed_mix(kernel);
      } catch (const InputError& error) {
        GTEST_SKIP() << error.what();
      }
      SCOPED_TRACE(testing::Message()
                   << plugin->name << ' ' << kernel.name << ' ' << name(kernel.precision));
      EXPECT_GT(mix.fma + mix.sums + mix.products, 0);
      EXPECT_GT(mix.loads, mix.stack_loads);
      EXPECT_GT(mix.stores, mix.stack_stores);
      if (!plugin->has_fma) {
        EXPECT_EQ(mix.fma, 0);
      }
    }
}

TEST_F(Microbenchmarks, AStepThatAModelCannotMakeIsSkippedWithTheReason) {
  const MicroSet set{{"rk4_step"}, {"*"}, {"f64"}, {"scalar"}, {"*"}, {1}, {10}};
  std::map<Model, std::string> skipped;
  for (const MicroCase& one : micro_cases(set)) skipped[one.model] = one.skipped;
  EXPECT_NE(skipped[Model::axial], "");
  EXPECT_NE(skipped[Model::bending].find("load"), std::string::npos) << skipped[Model::bending];
  for (const Model model :
       {Model::membrane, Model::planar, Model::linear, Model::small, Model::spatial})
    EXPECT_EQ(skipped[model], "") << name(model);
}

TEST_F(Microbenchmarks, StepsOfEveryModelThatCanMakeThemAreThoseOfTheReference) {
  const MicroSet set{{"rk4_step"}, {"*"}, {"*"}, {"scalar"}, {"*"}, {1}, {10}};
  for (const MicroCase& one : micro_cases(set))
    if (one.skipped.empty()) {
      EXPECT_LE(one.error(), one.tolerance()) << one.cell();
    }
}

TEST_F(Microbenchmarks, CeilingsOfOurOwnAreNumbers) {
  const auto is_number = [](double value) { return std::isfinite(value) && value > 0; };
  EXPECT_PRED1(is_number, own_peak_flops(instruction_set("scalar"), true, 1));
  for (const char* stream : {"load", "copy", "triad"})
    EXPECT_PRED1(is_number, own_bandwidth(instruction_set("scalar"), stream, 1 << 14, 1)) << stream;
}

std::set<std::string> recorded(const std::string& path) {
  std::set<std::string> cells;
  for (const Record& record : read_csv(path).rows)
    EXPECT_TRUE(cells.insert(text_in(record, "cell") + ' ' + text_in(record, "repetition")).second)
        << "twice";
  return cells;
}

TEST_F(Microbenchmarks, ARunThatWasCutOffGoesOnToTheSameSetOfRecords) {
  const MicroSet set{{"rotation", "stage_row"}, {"planar"}, {"f64"}, {"scalar"}, {"L1"}, {1}, {}};
  const auto run = [&](const std::string& path, bool resume) {
    RecordFile records(path, micro_columns(), resume);
    run_micro_cases("test", micro_cases(set), {3, 1e-5}, records,
                    [](double, double, const std::string&) {});
  };
  run(file("whole.csv"), false);
  const std::string text = read_text(file("whole.csv"));
  std::ofstream(file("cut.csv")) << text.substr(0, text.size() * 2 / 3); // in the middle of a row
  run(file("cut.csv"), true);
  EXPECT_EQ(recorded(file("cut.csv")), recorded(file("whole.csv")));
  EXPECT_EQ(recorded(file("whole.csv")).size(), 6u);
}

TEST_F(Microbenchmarks, ARoofIsTheSmallerOfPeakAndBandwidth) {
  const std::vector<Ceiling> ceilings{
      {true, "peak", "scalar", "f64", "", 0, 1, 10e9, "own", "", ""},
      {false, "load", "scalar", "", "L1", 0, 1, 40e9, "own", "", ""},
      {false, "triad", "scalar", "", "L1", 0, 1, 20e9, "own", "", ""}};
  Record record{{"cell", "a"},
                {"isa", instruction_set("scalar").march},
                {"precision", "f64"},
                {"level", "L1"},
                {"threads", "1"},
                {"cores", "2"},
                {"flops_per_element", "1"},
                {"bytes_per_element", "8"},
                {"repetition", "0"},
                {"steps", "10"},
                {"elements", "100"},
                {"wall_s", "1e-6"},
                {"sample_s", "1e-6"},
                {"check", "passed"},
                {"status", "ok"}};
  const Record row = kernel_table({record}, ceilings).rows.at(0);
  EXPECT_DOUBLE_EQ(number_in(row, "measured_ns_per_element"), 1);
  EXPECT_DOUBLE_EQ(number_in(row, "roof_flops_per_s"), 5e9);
  EXPECT_DOUBLE_EQ(number_in(row, "share_of_roof"), 0.2);
  EXPECT_EQ(text_in(row, "limiter"), "L1 bandwidth");
  record["check"] = "failed", record["status"] = "wrong";
  EXPECT_EQ(text_in(kernel_table({record}, ceilings).rows.at(0), "share_of_roof"), "");
}

} // namespace
} // namespace dss
