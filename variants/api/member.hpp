#pragma once
/// Members of a hybrid: executors of several variants that compute one scene together. Each
/// computes a part.
#include <string>
#include <vector>

namespace dss {

/// One member as the user writes it: VARIANT[@DEVICE][:THREADS][=WEIGHT].
struct Member {
  std::string variant, device;
  int threads = 1;
  double weight = 0; ///< relative size of its first share of the elements; 0: from measured speed
};

/// Reads a list of members, for example "avx512:1,opencl@cpu:1=9".
/// @param text  members separated by commas. A device that is a number or contains one of : , = [ ]
/// stands in brackets: "opencl@[0:1]:2". Either all members have a weight or none.
/// @throws InputError that names the member and says what is wrong with it
std::vector<Member> parse_members(const std::string& text);
/// The member in the syntax of parse_members, without its weight: "opencl@[0:1]:2".
std::string name(const Member& member);

/// How the members of a hybrid shared the work.
struct HybridInfo {
  struct Entry {
    std::string member;
    double speed = 0;  ///< last measured speed [element-steps/s]
    double share = 0;  ///< fraction of all elements at the end
    double step_s = 0; ///< last measured time to compute a step, without waiting for others [s]
  };
  std::vector<Entry> members; ///< those that compute
  int rebalances = 0;
  std::string reason; ///< predicted and measured times of an automatic choice
};

} // namespace dss
