#pragma once
/// Members of a hybrid: executors that compute one scene together, each a part of it.
#include <string>
#include <vector>

namespace dss {

/// One member as asked for: VARIANT[@DEVICE][:THREADS][=WEIGHT].
struct Member {
  std::string variant, device;
  int threads = 1;
  double weight = 0; ///< of its first share, relative; 0: as measured
};

/// "avx512:1,opencl@cpu:1=9": members separated by commas. A device that is a number, or has one of : , = [ ] in it, stands in brackets:
/// "opencl@[0:1]:2". Weights are of all members or of none.
/// @throws InputError: what is wrong with which member
std::vector<Member> parse_members(const std::string& text);
/// As parse_members takes it, without the weight: "opencl@[0:1]:2".
std::string name(const Member& member);

/// What became of a hybrid.
struct HybridInfo {
  struct Entry {
    std::string member;
    double speed = 0;  ///< as measured last, element-steps a second
    double share = 0;  ///< of all elements, at the end
    double step_s = 0; ///< computing a step, without waiting for others, as measured last
  };
  std::vector<Entry> members; ///< those that compute
  int rebalances = 0;
  std::string reason; ///< why these: predicted and measured times of an automatic choice
};

} // namespace dss
