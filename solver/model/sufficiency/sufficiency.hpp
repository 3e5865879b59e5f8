#pragma once
/// Proofs that a model holds all motion of a problem, from geometry, loads, clamps and start.
/// Without a proof, model_error.hpp bounds during the run what a model leaves out.
#include "kernels/model.hpp"
#include "solver/model/problem.hpp"

#include <string>

namespace dss {

/// Returns an empty text if every motion of the problem is along x, in one piece or in rows that
/// move alike; otherwise one line that says what is not. The axial model is then exact. Links along
/// x have gaps and rates along x, so they exert neither couples nor forces across, under either
/// law. No element turns. Links between rows that move alike have neither gap nor rate.
std::string why_not_axial(const Problem& problem);

/// Returns an empty text if the linear equations leave the plane z = const only by uz, rx and ry;
/// otherwise one line that says what moves within the plane. The body is one element thick with
/// links along x and y. The linear laws then map uz, rx, ry to forces along z and moments about x
/// and y, and the other three to the other three. This proves the degrees of freedom only: the
/// model is still linear, and the bound limits how far it may go.
std::string why_not_bending(const Problem& problem);

/// Returns an empty text if all elements move alike and none turns; otherwise one line. Then no
/// link is strained, and the models of small rotations are exact.
std::string why_not_in_translation(const Problem& problem);

/// Returns an empty text if the model has every degree of freedom that the problem moves (spatial,
/// small and linear have all six); otherwise one line that says what is missing.
std::string why_no_degrees(Model model, const Problem& problem);
/// The same; also if no rows of the model are compiled that step the problem in time.
std::string why_not(Model model, const Problem& problem);

/// Returns an empty text if the model's results are proven to equal those of the spatial model
/// except for rounding; otherwise one line.
std::string why_not_exact(Model model, const Problem& problem);

/// The cheapest model whose results are proven to equal those of the spatial model except for
/// rounding. It is `spatial` if there is no other.
Model smallest_exact(const Problem& problem);

/// Returns e.g. "body \"b\", element 12 starts with uy = 0.1 m" for the first element whose start
/// has one of these fields, or an empty text.
std::string start_with(const Problem& problem, std::initializer_list<Field> fields);

/// Returns e.g. "load 0 has force y = 2 N", or an empty text.
/// @param forces, torques  axes to check, 0 to 2
std::string load_along(const Problem& problem, std::initializer_list<int> forces,
                       std::initializer_list<int> torques);

/// A load whose tractions on faces add to the pressure of elements; empty if there is none.
std::string pressed_faces(const Problem& problem);

/// Returns e.g. "gravity or base acceleration acts along z", or an empty text.
std::string acceleration_along(const Problem& problem, std::initializer_list<int> axes);

/// Returns e.g. "body \"plate\" is more than one element thick in z" or "extra link 0 between
/// elements 1 and 2 is along z", or an empty text.
std::string thickness_in_z(const Problem& problem);

} // namespace dss
