#pragma once
/// Regions of likwid's marker API round what is timed, so that `likwid-perfctr -m` counts each kernel by itself. The library is opened when a run is
/// under likwid-perfctr, and not needed else.
#include <string>

namespace dss {

/// Empty if regions are counted, else why not: "not under likwid-perfctr -m".
const std::string& why_no_markers();

/// A region of the calling thread from here to the end of the scope; nothing where there are no markers.
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
