#include "experiments/measure/ceilings/assembled_loop.hpp"
#include "experiments/base/child.hpp"
#include "solver/error.hpp"

#include <array>
#include <cstdlib>
#include <dlfcn.h>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>

namespace dss {
namespace {

constexpr double assembler_limit_s = 30;

/// A temporary directory, removed by the destructor.
struct WorkDirectory {
  std::string path = (std::filesystem::temp_directory_path() / "dssbench-XXXXXX").string();
  WorkDirectory() {
    if (::mkdtemp(path.data()) == nullptr)
      throw InputError(fmt::format("{}: cannot make a directory", path));
  }
  ~WorkDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
};

void run_tool(const std::vector<std::string>& words) {
  std::vector<std::string> arguments{"env"};
  arguments.insert(arguments.end(), words.begin(), words.end());
  const ChildResult child = run_child("/usr/bin/env", arguments, assembler_limit_s);
  if (child.exit_code != 0)
    throw InputError(fmt::format("{} (binutils): {} {}", words.front(),
                                 child.failure(assembler_limit_s), child.error));
}

} // namespace

AssembledLoop::AssembledLoop(const std::string& body) {
  const WorkDirectory directory;
  const std::string text = directory.path + "/loop.s", object = directory.path + "/loop.o",
                    library = directory.path + "/loop.so";
  std::ofstream(text) << ".globl loop\n.type loop, @function\nloop:\n"
                      << body << "ret\n"
                      << ".section .note.GNU-stack,\"\",@progbits\n";
  run_tool({"as", "-o", object, text});
  run_tool({"ld", "-shared", "-o", library, object});
  module_ = ::dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (module_ == nullptr) throw InputError(fmt::format("generated code: {}", ::dlerror()));
  loop_ = reinterpret_cast<void (*)(const void*, void*, long)>(::dlsym(module_, "loop"));
}

AssembledLoop::~AssembledLoop() { ::dlclose(module_); }

} // namespace dss
