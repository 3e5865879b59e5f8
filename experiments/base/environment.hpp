#pragma once
/// Environment variables that the program reads. The manual page lists them.
#include <array>

namespace dss {

/// Name of a variable, and its meaning for the manual page.
struct EnvironmentVariable {
  const char *name, *meaning;
};

inline constexpr std::array environment_variables = {
    EnvironmentVariable{"DSSBENCH_VARIANT_PATH",
                        "Directories of variants built outside the source tree, separated by "
                        "colons; missing directories are ignored. --variant-path adds to them."},
    EnvironmentVariable{"DSSBENCH_SCENES", "Directory of scenes; it replaces the shipped one."},
    EnvironmentVariable{"DSSBENCH_EXPERIMENTS",
                        "Directory of experiments; it replaces the shipped one."},
    EnvironmentVariable{"DSSBENCH_HIDE_CPU_FEATURES",
                        "CPU features to ignore, separated by commas: avx512f,fma."},
    EnvironmentVariable{"DSSBENCH_KEEP_DENORMALS",
                        "1: keep denormal numbers instead of flushing them to zero."},
    EnvironmentVariable{
        "DSSBENCH_OPENCL_AS",
        "gpu or discrete: treat every OpenCL device as a GPU, or as one with memory of "
        "its own."},
    EnvironmentVariable{
        "DSSBENCH_STAGE_TILE",
        "What a work-group of a GPU computes in a launch: WIDTHxHEIGHTxSTAGES, or 0 "
        "for one stage of a row."},
    EnvironmentVariable{"DSSBENCH_PATIENCE_S",
                        "Time in seconds after which ranks give up waiting for another rank."},
    EnvironmentVariable{
        "DSSBENCH_FAULT",
        "Injects a fault for tests: die:RANK:EXCHANGE, hang:RANK:EXCHANGE or slow:RANK:FACTOR."},
    EnvironmentVariable{"DSSBENCH_FLIP",
                        "Flips a bit of the state of a run for tests: STEP:ELEMENT:NUMBER:BIT, "
                        "and :stays if it stays wrong."},
    EnvironmentVariable{"DSSBENCH_CACHE_DIR",
                        "Directory of compiled OpenCL programs (default: dssbench/opencl in "
                        "XDG_CACHE_HOME, or in ~/.cache)."},
};

} // namespace dss
