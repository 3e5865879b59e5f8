#pragma once
/// Numbers of a VTK file behind its XML, compressed.
#include "solver/io/atomic_file.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace dss {

/// The appended data of a file (encoding "raw", vtkZLibDataCompressor, headers of 64 bits). Arrays
/// are compressed in blocks, with all cores.
class AppendedData {
public:
  /// @return the offset of the array, for its DataArray
  std::size_t add(std::string_view bytes);
  /// Writes the element AppendedData.
  void write(AtomicFile& file) const;

private:
  std::string data_;
};

} // namespace dss
