#pragma once
/// Finds, checks and opens variants. This code is compiled for the baseline CPU, and checks the
/// CPU's features before it opens a module.
#include "variants/api/api.hpp"

#include <string>
#include <vector>

namespace dss {

/// A variant that this build knows, and whether it can run here.
struct VariantStatus {
  std::string name;
  std::string isa;      ///< instruction set that the module is compiled for
  std::string unusable; ///< empty if it can run here, else the reason: "this CPU lacks avx512f"
  /// auto never chooses it, because it computes on ranks or devices or was built outside the tree.
  bool is_by_name = false;
  /// Path of the module if it was built outside the tree (outside.hpp); else empty.
  std::string path{};
  bool is_usable() const { return unusable.empty(); }
  bool is_outside() const { return !path.empty(); }
};

/// All variants: first those of the registry that CMake generated, slowest first, then those built
/// outside the tree. No module is opened. An outside variant with a faulty description is unusable.
/// @throws InputError if an outside variant with a sound description has the name of another
/// variant
const std::vector<VariantStatus>& variants();
/// The same list, after opening the modules that need a library or a device and asking them whether
/// they can run here.
const std::vector<VariantStatus>& asked_variants();
/// The same, but no module from outside is opened: a mere list runs no foreign code.
std::vector<VariantStatus> listed_variants();
/// Path of a variant's module, whether or not the file exists: beside the program if that is
/// installed, else in the build tree. An outside variant has its own path.
std::string module_path(const VariantStatus& variant);
/// Names of the variants with explicit methods that can run here (asked_variants).
std::vector<std::string> usable_variants();

/// Opens a variant. The result stays valid until the program ends.
/// @param name  a variant, or "auto" for the fastest usable one
/// @throws InputError if the name is unknown (suggests the nearest), the CPU lacks a feature, or
/// the module does not load
const Plugin& load_variant(const std::string& name);
/// Why a variant does not compute a problem, after its name: "has no ..."; null if it does.
const char* missing_term(const Plugin& plugin, const Problem& problem);
/// @throws InputError if a term is missing
void require_terms(const Plugin& plugin, const Problem& problem);

/// Ends all opened variants. Call it once before the program ends.
/// @param exit_code    exit code of the program
/// @param is_in_order  false after an error that other ranks may not have met: then nobody may wait
/// for them
void end_variants(int exit_code, bool is_in_order);

} // namespace dss
