#pragma once
/// The key "leave_out" of a scale: labels of parts of a study that it does not measure.
#include "solver/json/object_node.hpp"

#include <set>
#include <string>
#include <vector>

namespace dss {

class LeftOut {
public:
  /// Reads the key. The scale must outlive this object.
  explicit LeftOut(ObjectNode& scale);
  /// True if the scale leaves out the part of that label.
  bool has(const std::string& label);
  /// Checks the labels against those that has() was asked for.
  /// @param what  what has a label, for the message
  /// @throws InputError if no part has a label
  void require_all_known(const std::string& what);

private:
  ObjectNode& scale_;
  const std::vector<std::string> labels_;
  std::set<std::string> known_;
};

} // namespace dss
