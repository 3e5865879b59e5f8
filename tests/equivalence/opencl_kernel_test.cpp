/// The OpenCL flavour of the shared physics: every kernel case is built as OpenCL C for the CPU device and gives the
/// same bits as packs.
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include "tests/equivalence/kernel_operands.hpp"
#include "variants/loader.hpp"

#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>

namespace dss::test {
namespace {

std::string shared_header(const std::string& path) {
  std::ifstream file(std::string(DSS_SOURCE_DIR) + "/kernels/" + path);
  EXPECT_TRUE(file) << path;
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The shared headers of a model over vectors of eight, and a kernel around one case.
std::string program_source(const CompiledKernel& kernel) {
  const std::string scalar = kernel.precision == Precision::f64 ? "double" : "float";
  std::string source = "#pragma OPENCL EXTENSION cl_khr_fp64 : enable\n#pragma OPENCL FP_CONTRACT OFF\n";
  source +=
      fmt::format("#define REAL {0}8\n#define SPLAT(a) (({0}8)({0})(a))\n#define FMA(a, b, c) fma(a, b, c)\n", scalar);
  const bool is_planar = kernel.model == Model::planar;
  if (is_planar) source += "#define PLANAR\n";
  source += shared_header(is_planar ? "algebra/planar.h" : "algebra/spatial.h");
  for (const char* header : {"link_force/link_force.h", "motion/motion.h", "rk_update/rk_update.h"})
    source += shared_header(header);
  if (!is_planar) source += shared_header("stress/stress.h");
  source += shared_header("cases.h");
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

class OpenClKernels : public testing::Test {
protected:
  void SetUp() override {
    cl_platform_id platform;
    cl_uint count = 0;
    if (clGetPlatformIDs(1, &platform, &count) != CL_SUCCESS || count == 0) GTEST_SKIP() << "no OpenCL platform";
    if (clGetDeviceIDs(platform, CL_DEVICE_TYPE_CPU, 1, &device, nullptr) != CL_SUCCESS)
      GTEST_SKIP() << "no OpenCL CPU device";
    context = clCreateContext(nullptr, 1, &device, nullptr, nullptr, &error);
    ASSERT_EQ(error, CL_SUCCESS);
    queue = clCreateCommandQueue(context, device, 0, &error);
    ASSERT_EQ(error, CL_SUCCESS);
  }
  void TearDown() override {
    if (queue != nullptr) clReleaseCommandQueue(queue);
    if (context != nullptr) clReleaseContext(context);
  }
  std::string build_log(cl_program program) const {
    std::size_t size = 0;
    clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, 0, nullptr, &size);
    std::string log(size, '\0');
    clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, size, log.data(), nullptr);
    return log;
  }
  template <class T>
  std::vector<T> run(const CompiledKernel& kernel, const Operands<T>& operands) {
    const std::string source = program_source(kernel);
    const char* text = source.c_str();
    cl_program program = clCreateProgramWithSource(context, 1, &text, nullptr, &error);
    EXPECT_EQ(error, CL_SUCCESS);
    EXPECT_EQ(clBuildProgram(program, 1, &device, "-cl-std=CL1.2", nullptr, nullptr), CL_SUCCESS) << build_log(program);
    cl_kernel entry = clCreateKernel(program, "run_case", &error);
    EXPECT_EQ(error, CL_SUCCESS);
    if (error != CL_SUCCESS) return {};
    std::vector<T> results(operands.output_count(), std::numeric_limits<T>::quiet_NaN());
    const std::size_t in_bytes = std::size_t(kernel.inputs) * Operands<T>::elements * sizeof(T),
                      out_bytes = results.size() * sizeof(T);
    cl_mem in = clCreateBuffer(context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, in_bytes,
                               const_cast<T*>(operands.inputs()), &error);
    cl_mem out = clCreateBuffer(context, CL_MEM_WRITE_ONLY, out_bytes, nullptr, &error);
    const cl_int stride = Operands<T>::elements;
    clSetKernelArg(entry, 0, sizeof in, &in);
    clSetKernelArg(entry, 1, sizeof out, &out);
    clSetKernelArg(entry, 2, sizeof stride, &stride);
    const std::size_t items = Operands<T>::elements / 8;
    EXPECT_EQ(clEnqueueNDRangeKernel(queue, entry, 1, nullptr, &items, nullptr, 0, nullptr, nullptr), CL_SUCCESS);
    EXPECT_EQ(clEnqueueReadBuffer(queue, out, CL_TRUE, 0, out_bytes, results.data(), 0, nullptr, nullptr), CL_SUCCESS);
    clReleaseMemObject(in);
    clReleaseMemObject(out);
    clReleaseKernel(entry);
    clReleaseProgram(program);
    return results;
  }
  template <class T>
  void expect_same_bits(const Plugin& plugin, const CompiledKernel& kernel) {
    const Operands<T> operands(kernel.inputs, kernel.outputs);
    EXPECT_EQ(count_differing(operands.run(kernel), run(kernel, operands)), 0u)
        << kernel.name << ' ' << name(kernel.model) << ' ' << name(kernel.precision) << ": OpenCL and " << plugin.name;
  }

  cl_device_id device = nullptr;
  cl_context context = nullptr;
  cl_command_queue queue = nullptr;
  cl_int error = CL_SUCCESS;
};

TEST_F(OpenClKernels, give_the_same_bits_as_the_fastest_variant_with_fma) {
  const Plugin& plugin = load_variant("auto");
  if (!plugin.has_fma || plugin.kernels == nullptr) GTEST_SKIP() << plugin.name << " has no FMA";
  for (const CompiledKernel& kernel : plugin.kernels())
    if (kernel.precision == Precision::f64)
      expect_same_bits<double>(plugin, kernel);
    else
      expect_same_bits<float>(plugin, kernel);
}

} // namespace
} // namespace dss::test
