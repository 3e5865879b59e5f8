#pragma once
/// The state as a table, one row an element.
#include "solver/io/atomic_file.hpp"
#include "solver/model/problem.hpp"
#include "solver/model/stress/stress_field.hpp"

#include <array>
#include <span>

namespace dss {

/// Writes the columns element,x,y,z,ux,uy,uz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz,stress_vm: the rest
/// position of the centre [m], the fields of kernels/fields.hpp (qw = 1 + qs), and the von Mises
/// stress [Pa]. Rows are in global grid order. Every number has 17 digits, in the C locale.
/// @param file    its caller commits it
/// @param state   13 numbers an element
/// @param stress  one entry an element
/// @throws InputError if the file cannot be written
void write_state_csv(AtomicFile& file, const Problem& problem, std::span<const double> state,
                     std::span<const ElementStress> stress);

} // namespace dss
