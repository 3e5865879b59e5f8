#pragma once
/// VTK XML output, readable by ParaView. Every element is a hexahedron of its own, because elements
/// are rigid and gaps open between them.
#include "solver/io/state_csv.hpp"
#include "solver/model/problem.hpp"

#include <span>
#include <string>
#include <vector>

namespace dss {

/// Writes one state as an unstructured grid (.vtu, inline base64, 64-bit floats). Points are the
/// corners at rest; point data `displacement` [m] moves them (ParaView: Warp By Vector). Cell data:
/// displacement [m], velocity [m/s], rotation_vector [rad], stress [Pa] (VTK's order: xx, yy, zz,
/// xy, yz, xz) and von_mises [Pa].
/// @param file    its caller commits it
/// @param state   13 numbers an element
/// @param stress  one entry an element
/// @throws InputError if the file cannot be written
void write_vtu(AtomicFile& file, const Problem& problem, std::span<const double> state,
               std::span<const ElementStress> stress);

/// One file of a series: its name relative to the .pvd file, and its time [s].
struct Frame {
  std::string file;
  double time = 0;
};

/// Writes the index of a series of .vtu files (.pvd).
/// @throws InputError if it cannot be written
void write_pvd(const std::string& path, std::span<const Frame> frames);

} // namespace dss
