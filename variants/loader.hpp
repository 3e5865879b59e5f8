#pragma once
/// Finds, checks and opens variants. The feature check is compiled for the baseline CPU and runs before a module is
/// opened.
#include "variants/api.hpp"

#include <string>
#include <vector>

namespace dss {

/// A variant this build knows, and whether it can run here.
struct VariantStatus {
  std::string name;
  std::string isa;         ///< what the module is compiled for
  std::string unusable;    ///< empty if it can run here, else the reason: "this CPU lacks avx512f"
  bool is_by_name = false; ///< never the choice of auto: it computes on ranks or devices, or was built outside
  std::string path{};      ///< of the module of a variant built outside the tree (outside.hpp); else empty
  bool is_usable() const { return unusable.empty(); }
  bool is_outside() const { return !path.empty(); }
};

/// Every variant of the registry that CMake generated, slowest first, then those built outside. Needs no module to be
/// opened. One built outside that is not as it should be is unusable. @throws InputError where a sound one has the name
/// of another
const std::vector<VariantStatus>& variants();
/// The same, where modules that need more than a CPU (a library, a device) have been opened and asked.
const std::vector<VariantStatus>& asked_variants();
/// Where its module is or would be: beside the program when installed, else in the build tree; an outside variant says.
std::string module_path(const VariantStatus& variant);
/// Names of those that can run here.
std::vector<std::string> usable_variants();

/// Opens a variant ("auto": the fastest usable one). The result stays valid until the program ends.
/// @throws InputError for an unknown name (naming the known ones), a CPU that lacks a feature, or a module that does
/// not load.
const Plugin& load_variant(const std::string& name);

/// To be called once before the program ends with `exit_code`. Not in order: after an error that other ranks may not have
/// met, whom nobody may wait for.
void end_variants(int exit_code, bool is_in_order);

} // namespace dss
