#include "variants/opencl/opencl.hpp"
#include "solver/error.hpp"

#include <fmt/format.h>

namespace dss::opencl {
namespace {

/// CL_PLATFORM_NOT_FOUND_KHR, an error of the loader (cl_khr_icd).
constexpr cl_int platform_not_found = -1001;

const char* advice(cl_int status) {
  switch (status) {
  case CL_MEM_OBJECT_ALLOCATION_FAILURE:
  case CL_OUT_OF_RESOURCES:
  case CL_OUT_OF_HOST_MEMORY:
  case CL_INVALID_BUFFER_SIZE:
    return "its memory does not suffice; take a smaller scene, --precision f32, or another "
           "--device";
  case CL_DEVICE_NOT_AVAILABLE:
  case CL_DEVICE_NOT_FOUND:
    return "the device is in use or gone; `dssbench list devices` shows what is there";
  case CL_COMPILER_NOT_AVAILABLE:
    return "its driver has no compiler; take another --device";
  case CL_INVALID_KERNEL_NAME:
    return "the program has no such kernel, or its name is one of OpenCL's own";
  case CL_INVALID_WORK_GROUP_SIZE:
  case CL_INVALID_WORK_ITEM_SIZE:
    return "its work-groups are smaller than the kernel needs; take another --device";
  case platform_not_found:
    return "no OpenCL platform; install one: pocl-opencl-icd for the CPU, or the driver of the GPU";
  default:
    return "an error of its driver or of dssbench; try another --device";
  }
}

} // namespace

std::string status_name(cl_int status) {
  switch (status) {
#define DSS_STATUS(name)                                                                           \
  case name:                                                                                       \
    return #name
    DSS_STATUS(CL_SUCCESS);
    DSS_STATUS(CL_DEVICE_NOT_FOUND);
    DSS_STATUS(CL_DEVICE_NOT_AVAILABLE);
    DSS_STATUS(CL_COMPILER_NOT_AVAILABLE);
    DSS_STATUS(CL_MEM_OBJECT_ALLOCATION_FAILURE);
    DSS_STATUS(CL_OUT_OF_RESOURCES);
    DSS_STATUS(CL_OUT_OF_HOST_MEMORY);
    DSS_STATUS(CL_PROFILING_INFO_NOT_AVAILABLE);
    DSS_STATUS(CL_MEM_COPY_OVERLAP);
    DSS_STATUS(CL_BUILD_PROGRAM_FAILURE);
    DSS_STATUS(CL_MAP_FAILURE);
    DSS_STATUS(CL_MISALIGNED_SUB_BUFFER_OFFSET);
    DSS_STATUS(CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST);
    DSS_STATUS(CL_COMPILE_PROGRAM_FAILURE);
    DSS_STATUS(CL_LINKER_NOT_AVAILABLE);
    DSS_STATUS(CL_LINK_PROGRAM_FAILURE);
    DSS_STATUS(CL_DEVICE_PARTITION_FAILED);
    DSS_STATUS(CL_KERNEL_ARG_INFO_NOT_AVAILABLE);
    DSS_STATUS(CL_INVALID_VALUE);
    DSS_STATUS(CL_INVALID_DEVICE_TYPE);
    DSS_STATUS(CL_INVALID_PLATFORM);
    DSS_STATUS(CL_INVALID_DEVICE);
    DSS_STATUS(CL_INVALID_CONTEXT);
    DSS_STATUS(CL_INVALID_QUEUE_PROPERTIES);
    DSS_STATUS(CL_INVALID_COMMAND_QUEUE);
    DSS_STATUS(CL_INVALID_HOST_PTR);
    DSS_STATUS(CL_INVALID_MEM_OBJECT);
    DSS_STATUS(CL_INVALID_BINARY);
    DSS_STATUS(CL_INVALID_BUILD_OPTIONS);
    DSS_STATUS(CL_INVALID_PROGRAM);
    DSS_STATUS(CL_INVALID_PROGRAM_EXECUTABLE);
    DSS_STATUS(CL_INVALID_KERNEL_NAME);
    DSS_STATUS(CL_INVALID_KERNEL_DEFINITION);
    DSS_STATUS(CL_INVALID_KERNEL);
    DSS_STATUS(CL_INVALID_ARG_INDEX);
    DSS_STATUS(CL_INVALID_ARG_VALUE);
    DSS_STATUS(CL_INVALID_ARG_SIZE);
    DSS_STATUS(CL_INVALID_KERNEL_ARGS);
    DSS_STATUS(CL_INVALID_WORK_DIMENSION);
    DSS_STATUS(CL_INVALID_WORK_GROUP_SIZE);
    DSS_STATUS(CL_INVALID_WORK_ITEM_SIZE);
    DSS_STATUS(CL_INVALID_GLOBAL_OFFSET);
    DSS_STATUS(CL_INVALID_EVENT_WAIT_LIST);
    DSS_STATUS(CL_INVALID_EVENT);
    DSS_STATUS(CL_INVALID_OPERATION);
    DSS_STATUS(CL_INVALID_BUFFER_SIZE);
    DSS_STATUS(CL_INVALID_GLOBAL_WORK_SIZE);
    DSS_STATUS(CL_INVALID_PROPERTY);
    DSS_STATUS(CL_INVALID_COMPILER_OPTIONS);
    DSS_STATUS(CL_INVALID_LINKER_OPTIONS);
    DSS_STATUS(CL_INVALID_DEVICE_PARTITION_COUNT);
#undef DSS_STATUS
  case platform_not_found:
    return "CL_PLATFORM_NOT_FOUND_KHR";
  default:
    return fmt::format("OpenCL status {}", status);
  }
}

void fail(std::string_view device, const cl::Error& error) {
  throw InputError(fmt::format("opencl: {} on {}: {}: {}", error.what(), device,
                               status_name(error.err()), advice(error.err())));
}

} // namespace dss::opencl
