/// The shared physics in OpenCL C: every kernel case is built for the CPU device and must give the
/// bits of packs.
#include "kernels/model.hpp"
#include "tests/equivalence/kernel_operands.hpp"
#include "tests/equivalence/opencl_run.hpp"
#include "variants/opencl/queue.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <fstream>

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

/// The shared headers of a model for vectors of eight, and a kernel around one case.
std::string program_source(const CompiledKernel& kernel) {
  const std::string scalar = kernel.precision == Precision::f64 ? "double" : "float";
  std::string source =
      "#pragma OPENCL EXTENSION cl_khr_fp64 : enable\n#pragma OPENCL FP_CONTRACT OFF\n";
  source += fmt::format(
      "#define REAL {0}8\n#define SPLAT(a) (({0}8)({0})(a))\n#define FMA(a, b, c) fma(a, b, c)\n",
      scalar);
  source += shared_header(fmt::format("kernels/algebra/{}.h", name(kernel.model))) +
            shared_header("kernels/laws.h");
  if (kernel.model == Model::spatial)
    source += "#define STRESS\n" + shared_header("kernels/stress/stress.h");
  source += shared_header("kernels/case_functions.h");
  source += fmt::format(R"(
__kernel void run_case(__global const {0} *in, __global {0} *out, int stride) {{
  REAL operands[{1}], results[{2}];
  int e = get_global_id(0) * 8;
  for (int n = 0; n < {1}; ++n) operands[n] = vload8(0, in + n * stride + e);
  case_{3}(operands, results);
  for (int n = 0; n < {2}; ++n) vstore8(results[n], 0, out + n * stride + e);
}})",
                        scalar, kernel.inputs, kernel.outputs, kernel.name);
  return source;
}

template <class T>
std::vector<T> run_on(opencl::Queue& queue, const CompiledKernel& kernel,
                      const Operands<T>& operands) {
  std::vector<T> results(operands.output_count(), std::numeric_limits<T>::quiet_NaN());
  const std::size_t inputs = std::size_t(kernel.inputs) * Operands<T>::elements;
  const opencl::Buffer in = queue.make_buffer(inputs * sizeof(T)),
                       out = queue.make_buffer(results.size() * sizeof(T));
  queue.write(in, 0, std::as_bytes(std::span(operands.inputs(), inputs)));
  opencl::Kernel entry =
      queue.make_kernel(opencl::build_program(queue.device(), program_source(kernel)), "run_case");
  entry.set(in, out, cl_int(Operands<T>::elements));
  queue.launch(entry, cl::NDRange(Operands<T>::elements / 8));
  queue.read(out, 0, std::as_writable_bytes(std::span(results)));
  return results;
}

template <class T>
std::size_t differing(opencl::Queue& queue, const CompiledKernel& kernel) {
  const Operands<T> operands(kernel.inputs, kernel.outputs);
  return count_differing(operands.run(kernel), run_on(queue, kernel, operands));
}

TEST_F(OpenCl, kernels_have_the_bits_of_packs) {
  if (packs().kernels == nullptr) GTEST_SKIP() << packs().name << " has no kernels";
  opencl::Queue queue(opencl::find_device("", Precision::f64));
  for (const CompiledKernel& kernel : packs().kernels())
    if (!kernel.is_row) {
      EXPECT_EQ(kernel.precision == Precision::f64 ? differing<double>(queue, kernel)
                                                   : differing<float>(queue, kernel),
                0u)
          << kernel.name << ' ' << name(kernel.model) << ' ' << name(kernel.precision)
          << ": OpenCL and " << packs().name;
    }
}

} // namespace
} // namespace dss::test
