/// The shared physics in OpenCL C: every kernel case is built for the CPU device and must give the
/// bits of packs.
#include "kernels/model.hpp"
#include "tests/equivalence/kernel_operands.hpp"
#include "tests/equivalence/opencl_run.hpp"
#include "variants/opencl/queue.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <span>

namespace dss::test {
namespace {

/// A file of the tree with its shared includes expanded.
std::string shared_header(const std::string& path) {
  std::ifstream file(std::filesystem::path(DSS_SOURCE_DIR) / path);
  EXPECT_TRUE(file) << path;
  std::string text;
  for (std::string line; std::getline(file, line);)
    text += line.starts_with("#include \"") ? shared_header(line.substr(10, line.size() - 11))
                                            : line + "\n";
  return text;
}

/// A kernel around one case, for vectors of eight.
std::string kernel_source(const CompiledKernel& kernel) {
  return fmt::format(R"(
__kernel void run_{3}(__global const {0} *in, __global {0} *out, int stride) {{
  REAL operands[{1}], results[{2}];
  int e = get_global_id(0) * 8;
  for (int n = 0; n < {1}; ++n) operands[n] = vload8(0, in + n * stride + e);
  case_{3}(operands, results);
  for (int n = 0; n < {2}; ++n) vstore8(results[n], 0, out + n * stride + e);
}})",
                     kernel.precision == Precision::f64 ? "double" : "float", kernel.inputs,
                     kernel.outputs, kernel.name);
}

/// The shared headers of a model.
std::string shared_source(Model model, Precision precision) {
  std::string source =
      "#pragma OPENCL EXTENSION cl_khr_fp64 : enable\n#pragma OPENCL FP_CONTRACT OFF\n";
  source += fmt::format(
      "#define REAL {0}8\n#define SPLAT(a) (({0}8)({0})(a))\n#define FMA(a, b, c) fma(a, b, c)\n",
      precision == Precision::f64 ? "double" : "float");
  source += shared_header(fmt::format("kernels/algebra/{}.h", name(model))) +
            shared_header("kernels/laws.h");
  if (model == Model::spatial)
    source += "#define STRESS\n" + shared_header("kernels/stress/stress.h");
  return source + shared_header("kernels/case_functions.h");
}

using KernelGroups = std::map<std::pair<Model, Precision>, std::vector<CompiledKernel>>;
/// The cases of a model and precision share a program: PoCL takes a quarter of a second for each.
KernelGroups kernel_groups(std::span<const CompiledKernel> kernels) {
  KernelGroups groups;
  for (const CompiledKernel& kernel : kernels)
    if (!kernel.is_row) groups[{kernel.model, kernel.precision}].push_back(kernel);
  return groups;
}

template <class T>
std::vector<T> run_on(opencl::Queue& queue, const opencl::Program& program,
                      const CompiledKernel& kernel, const Operands<T>& operands) {
  std::vector<T> results(operands.output_count(), std::numeric_limits<T>::quiet_NaN());
  const std::size_t inputs = std::size_t(kernel.inputs) * Operands<T>::elements;
  const opencl::Buffer in = queue.make_buffer(inputs * sizeof(T)),
                       out = queue.make_buffer(results.size() * sizeof(T));
  queue.write(in, 0, std::as_bytes(std::span(operands.inputs(), inputs)));
  opencl::Kernel entry = queue.make_kernel(program, fmt::format("run_{}", kernel.name).c_str());
  entry.set(in, out, cl_int(Operands<T>::elements));
  queue.launch(entry, cl::NDRange(Operands<T>::elements / 8));
  queue.read(out, 0, std::as_writable_bytes(std::span(results)));
  return results;
}

template <class T>
std::size_t differing(opencl::Queue& queue, const opencl::Program& program,
                      const CompiledKernel& kernel) {
  const Operands<T> operands(kernel.inputs, kernel.outputs);
  return count_differing(operands.run(kernel), run_on(queue, program, kernel, operands));
}

TEST_F(OpenCl, kernels_have_the_bits_of_packs) {
  if (packs().kernels == nullptr) GTEST_SKIP() << packs().name << " has no kernels";
  opencl::Queue queue(opencl::find_device("", Precision::f64));
  for (const auto& [group, kernels] : kernel_groups(packs().kernels())) {
    const auto& [model, precision] = group;
    std::string source = shared_source(model, precision);
    for (const CompiledKernel& kernel : kernels) source += kernel_source(kernel);
    const opencl::Program program = opencl::build_program(queue.device(), source);
    for (const CompiledKernel& kernel : kernels)
      EXPECT_EQ(precision == Precision::f64 ? differing<double>(queue, program, kernel)
                                            : differing<float>(queue, program, kernel),
                0u)
          << kernel.name << ' ' << name(model) << ' ' << name(precision) << ": OpenCL and "
          << packs().name;
  }
}

} // namespace
} // namespace dss::test
