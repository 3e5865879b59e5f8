#pragma once
/// Variables of the environment that the program reads, for its manual page.
#include <array>

namespace dss {

struct EnvironmentVariable {
  const char *name, *meaning;
};

inline constexpr std::array environment_variables = {
    EnvironmentVariable{"DSSBENCH_VARIANT_PATH",
                        "Directories of variants built outside the source tree, separated by colons; those that are "
                        "not there count for nothing. --variant-path adds to them."},
    EnvironmentVariable{"DSSBENCH_SCENES", "The directory of scenes in place of the shipped one."},
    EnvironmentVariable{"DSSBENCH_EXPERIMENTS", "The directory of experiments in place of the shipped one."},
    EnvironmentVariable{"DSSBENCH_HIDE_CPU_FEATURES",
                        "CPU features, separated by commas, that the CPU shall not have: avx512f,fma."},
    EnvironmentVariable{"DSSBENCH_KEEP_DENORMALS", "1: denormal numbers are computed with, not flushed to zero."},
    EnvironmentVariable{"DSSBENCH_OPENCL_AS", "gpu or cpu: OpenCL devices are used as such a one, whatever they are."},
    EnvironmentVariable{"DSSBENCH_PATIENCE_S", "Seconds after which ranks give up one that says nothing."},
    EnvironmentVariable{"DSSBENCH_FAULT",
                        "To try what happens: die:RANK:EXCHANGE, hang:RANK:EXCHANGE or slow:RANK:FACTOR."},
    EnvironmentVariable{
        "DSSBENCH_CACHE_DIR",
        "Where compiled OpenCL programs are kept (default: dssbench/opencl in XDG_CACHE_HOME, or in ~/.cache)."},
};

} // namespace dss
