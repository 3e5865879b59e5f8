#pragma once
/// A study whose work stands under a key of its own, such as "stability", in place of cells.
#include "experiments/runner/study_reader.hpp"

#include <memory>
#include <optional>
#include <string>

namespace dss {

struct KeyedStudy {
  std::shared_ptr<const nlohmann::json> json; ///< what the places refer to
  std::string path, name, title;
  JsonPlace work;  ///< value of the key
  JsonPlace scale; ///< of `scales`, the asked for
};

/// The scale of that name of a study. @throws InputError naming the nearest
JsonPlace scale_of(const JsonPlace& root, const std::string& name);

/// Opens a study by name or path; nothing if it has not this key.
/// @throws InputError: file, JSON pointer, what is wrong and what would be right
std::optional<KeyedStudy> open_study(const std::string& study, const char* key, const std::string& scale);

} // namespace dss
