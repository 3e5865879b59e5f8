#include "experiments/measure/kernels/likwid_markers.hpp"

#include <cstdlib>
#include <dlfcn.h>
#include <type_traits>

namespace dss {
namespace {

/// The functions of liblikwid that the macros of its header call.
struct MarkerLibrary {
  void (*init)() = nullptr;
  void (*thread_init)() = nullptr;
  int (*start)(const char*) = nullptr;
  int (*stop)(const char*) = nullptr;
  void (*close)() = nullptr;
  std::string missing;

  MarkerLibrary() {
    // likwid-perfctr -m sets it to the file of its counts
    if (std::getenv("LIKWID_FILEPATH") == nullptr) {
      missing = "not under likwid-perfctr -m";
      return;
    }
    void* library = nullptr;
    for (const char* name : {"liblikwid.so", "liblikwid.so.5.2", "liblikwid.so.5"})
      if (library == nullptr) library = ::dlopen(name, RTLD_NOW | RTLD_GLOBAL);
    const auto find = [&](const char* name, auto& function) {
      if (library != nullptr)
        function =
            reinterpret_cast<std::remove_reference_t<decltype(function)>>(::dlsym(library, name));
      if (function == nullptr) missing = std::string("liblikwid has no ") + name;
    };
    find("likwid_markerInit", init);
    find("likwid_markerThreadInit", thread_init);
    find("likwid_markerStartRegion", start);
    find("likwid_markerStopRegion", stop);
    find("likwid_markerClose", close);
    if (missing.empty()) init();
  }
  ~MarkerLibrary() {
    if (missing.empty()) close(); // writes the counts
  }
};

const MarkerLibrary& marker_library() {
  static const MarkerLibrary library;
  return library;
}

} // namespace

const std::string& why_no_markers() { return marker_library().missing; }

MarkedRegion::MarkedRegion(std::string name) : name_(std::move(name)) {
  if (!why_no_markers().empty()) return;
  marker_library().thread_init();
  marker_library().start(name_.c_str());
}

MarkedRegion::~MarkedRegion() {
  if (why_no_markers().empty()) marker_library().stop(name_.c_str());
}

} // namespace dss
