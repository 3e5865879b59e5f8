#pragma once
/// The file of a study: found by name, parsed once, with one of its scales.

#include "solver/json/object_node.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace dss {

/// A study in the study directory.
struct StudyListing {
  std::string name, title, path;
};

/// Lists the studies that this program finds: *.json in the study directory and in its folders. The
/// directory is $DSSBENCH_EXPERIMENTS, or else experiments/studies.
std::vector<StudyListing> list_studies();

/// Path of a study, given its name or path. @throws InputError with the nearest known name
std::string study_path(const std::string& name_or_path);

/// Names of a study's scales, given its name or path. Empty if there is no such study or it has no
/// scales.
std::vector<std::string> scale_names(const std::string& name_or_path);

/// Keys that a file must have, from its contents.
using FurtherKeys = std::function<std::vector<std::string>(ObjectNode& root)>;

/// The part that every kind of study has. A kind has its own keys in `root`.
struct StudyFile {
  std::shared_ptr<const JsonFile> json; ///< the parsed file; `root` and `scale` refer to it
  std::string path, name, title, scale_name;
  Node root;
  Node scale; ///< the member of "scales" that was asked for

  /// The value of a key of `root`. @throws InputError if it is missing
  Node part(const std::string& key) const { return ObjectNode(root).require(key); }
};

/// Opens a study, given its name or path, with one of its scales.
/// @param further_keys  gives the keys that this file must have besides the common ones
/// @throws InputError with the file, the JSON pointer, the mistake and a correct example
StudyFile open_study(const std::string& study, const std::string& scale,
                     const FurtherKeys& further_keys = {});

} // namespace dss
