#include "experiments/measure/ceilings/assembled_loop.hpp"
#include "experiments/base/child.hpp"
#include "experiments/base/temporary_file.hpp"
#include "solver/error.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

namespace dss {
namespace {

constexpr double assembler_limit_s = 30;

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
  const TemporaryFile text(".globl loop\n.type loop, @function\nloop:\n" + body +
                               "ret\n.section .note.GNU-stack,\"\",@progbits\n",
                           ".s"),
      object("", ".o"), library("", ".so");
  run_tool({"as", "-o", object.path(), text.path()});
  run_tool({"ld", "-shared", "-o", library.path(), object.path()});
  module_ = ::dlopen(library.path().c_str(), RTLD_NOW | RTLD_LOCAL);
  if (module_ == nullptr) throw InputError(fmt::format("generated code: {}", ::dlerror()));
  loop_ = reinterpret_cast<void (*)(const void*, void*, long)>(::dlsym(module_, "loop"));
}

AssembledLoop::~AssembledLoop() { ::dlclose(module_); }

} // namespace dss
