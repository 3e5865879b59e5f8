#pragma once
/// VTK XML output, readable by ParaView. Elements share their corners, so a body that is warped
/// looks whole although its elements are rigid and gaps open between them.
#include "solver/io/atomic_file.hpp"
#include "solver/io/vtk/stress_output.hpp"
#include "solver/model/problem.hpp"

#include <span>
#include <string>
#include <vector>

namespace dss {

/// Writes one state as an unstructured grid (.vtu, compressed appended data, 64-bit floats). Points
/// are nodes at rest. Point data, means of what the elements at a node have there: displacement
/// [m], which moves them (ParaView: Warp By Vector), stress and von_mises [Pa]. Cell data, in the
/// middle of elements: displacement [m], velocity [m/s], rotation_vector [rad], stress, von_mises
/// and principal_stress [Pa], strain, the number of its body and, of bodies of several materials,
/// that of its material. Field data: TimeValue [s], and the names of the scene, its bodies and the
/// units. Tensors have VTK's order: xx, yy, zz, xy, yz, xz.
/// @param file    its caller commits it
/// @param time    [s]
/// @param state   13 numbers an element
/// @throws InputError if the file cannot be written
void write_vtu(AtomicFile& file, const Problem& problem, double time, std::span<const double> state,
               const StressOutput& stress);

/// One file of a series: its name relative to the .pvd file, and its time [s].
struct Frame {
  std::string file;
  double time = 0;
};

/// Writes the index of a series of .vtu files (.pvd).
/// @throws InputError if it cannot be written
void write_pvd(const std::string& path, std::span<const Frame> frames);

} // namespace dss
