#include "solver/statics/cholmod_library.hpp"

#include "solver/error.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>

namespace dss {
namespace {

/// Name by which the loader knows the version that the header describes.
std::string file_name() { return fmt::format("libcholmod.so.{}", CHOLMOD_MAIN_VERSION); }

/// A variable of the environment with another value, for a while.
class Setting {
public:
  Setting(const char* name, const char* value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before, had_value_ = true;
    ::setenv(name, value, 1);
  }
  ~Setting() {
    if (had_value_)
      ::setenv(name_, before_.c_str(), 1);
    else
      ::unsetenv(name_);
  }
  Setting(const Setting&) = delete;

private:
  const char* name_;
  std::string before_;
  bool had_value_ = false;
};

/// The opened library. It is never closed: threads of its BLAS may run.
class Opened {
public:
  Opened() {
    // Without this, OpenBLAS starts a thread for each core as it is loaded.
    const Setting one_thread("OPENBLAS_NUM_THREADS", "1");
    handle_ = ::dlopen(file_name().c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle_ == nullptr)
      throw InputError(fmt::format("factors need CHOLMOD, which cannot be loaded ({}); install "
                                   "libcholmod{}",
                                   ::dlerror(), CHOLMOD_MAIN_VERSION));
  }
  template <class Function>
  void find(Function& function, const char* name) const {
    function = optional<Function>(name);
    if (function == nullptr)
      throw InputError(fmt::format("{} has no function {}", file_name(), name));
  }
  /// A function of the library or of those that it needs; null if there is none.
  template <class Function>
  Function optional(const char* name) const {
    return reinterpret_cast<Function>(::dlsym(handle_, name));
  }

private:
  void* handle_ = nullptr;
};

const Opened& opened() {
  static const Opened library;
  return library;
}

/// What the library's OpenMP allows. Null if it has none.
struct OpenMp {
  int (*get_levels)();
  void (*set_levels)(int);
};

/// Found once, since every solution asks.
const OpenMp& its_openmp() {
  static const OpenMp found{opened().optional<int (*)()>("omp_get_max_active_levels"),
                            opened().optional<void (*)(int)>("omp_set_max_active_levels")};
  return found;
}

int threads = 1; ///< of the library and its BLAS

CholmodLibrary load() {
  const Opened& library = opened();
  CholmodLibrary functions{};
  library.find(functions.start, "cholmod_start");
  library.find(functions.finish, "cholmod_finish");
  library.find(functions.analyze, "cholmod_analyze");
  library.find(functions.analyze_p, "cholmod_analyze_p");
  library.find(functions.factorize, "cholmod_factorize");
  library.find(functions.change_factor, "cholmod_change_factor");
  library.find(functions.solve2, "cholmod_solve2");
  library.find(functions.free_factor, "cholmod_free_factor");
  library.find(functions.free_dense, "cholmod_free_dense");
  use_cholmod_threads(1);
  return functions;
}

} // namespace

const CholmodLibrary& cholmod() {
  static const CholmodLibrary library = load();
  return library;
}

std::string why_no_cholmod() {
  try {
    cholmod();
    return {};
  } catch (const InputError& error) {
    return error.what();
  }
}

int use_cholmod_threads(int count) {
  using Set = void (*)(int);
  using Get = int (*)();
  const Opened& library = opened();
  if (const auto set = library.optional<Set>("openblas_set_num_threads")) set(count);
  const auto get = library.optional<Get>("openblas_get_num_threads");
  return threads = get != nullptr ? get() : 1;
}

CholmodLoops::CholmodLoops() {
  const OpenMp& openmp = its_openmp();
  if (threads > 1 || openmp.get_levels == nullptr || openmp.set_levels == nullptr) return;
  levels_ = openmp.get_levels();
  openmp.set_levels(0);
}

CholmodLoops::~CholmodLoops() {
  if (levels_ >= 0) its_openmp().set_levels(levels_);
}

} // namespace dss
