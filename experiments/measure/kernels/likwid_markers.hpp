#pragma once
/// Regions of likwid's marker API around timed code, so that `likwid-perfctr -m` counts each kernel
/// separately. The library is opened only if the program runs under likwid-perfctr.
#include <string>

namespace dss {

/// Empty if regions are counted, else the reason: "not under likwid-perfctr -m".
const std::string& why_no_markers();

/// Marks a region of the calling thread until the end of the scope. Does nothing without markers.
class MarkedRegion {
public:
  explicit MarkedRegion(std::string name);
  MarkedRegion(const MarkedRegion&) = delete;
  MarkedRegion& operator=(const MarkedRegion&) = delete;
  ~MarkedRegion();

private:
  std::string name_;
};

} // namespace dss
