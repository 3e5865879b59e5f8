#pragma once
/// The state as a table, one row an element.
#include "solver/model/problem.hpp"
#include "solver/model/stress.hpp"

#include <array>
#include <span>
#include <string>

namespace dss {

/// Writes element,x,y,z,ux,uy,uz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz,stress_vm: rest position of the centre [m], then the
/// fields of solver/model/fields.hpp (qw = 1 + qs), in global grid order, every number with 17 digits. C locale.
/// @param state   13 numbers an element  @param stress  one entry an element
/// @throws InputError if the file cannot be written; an earlier file then stays as it was
void write_state_csv(const std::string& path, const Problem& problem, std::span<const double> state,
                     std::span<const ElementStress> stress);

} // namespace dss
