#pragma once
/// Which models hold all of a problem's motion, by proof from its geometry, loads, clamps and start. Where there is no proof, model_error.hpp bounds
/// what a model leaves out while it runs.
#include "solver/model/model.hpp"
#include "solver/model/problem.hpp"

#include <string>

namespace dss {

/// Empty if every motion of the problem is along x, in one piece or in rows that move alike, else one line that says what is not.
/// Then the axial model is exact: links along x have gaps and rates along x, which exert neither couples nor forces across, whatever the law; no
/// element turns; links between rows that move alike have neither gap nor rate.
std::string why_not_axial(const Problem& problem);

/// Empty if the linear equations leave the plane z = const only by uz, rx and ry, else one line that says what moves within it. One element thick, links
/// along x and y: the linear laws then map uz, rx, ry to forces along z and moments about x and y, and the other three to the other three. The model
/// is still linear: how far it may go is a question of the bound.
std::string why_not_bending(const Problem& problem);

/// Empty if all elements move alike and none turns, so that no link is strained, and models of small rotations are exact, else one line.
std::string why_not_in_translation(const Problem& problem);

/// Empty if the model has every degree of freedom that the problem moves (spatial, small and linear have all six), else one line that says
/// what leaves them.
std::string why_not(Model model, const Problem& problem);

/// Empty if the model's results are proven to be those of the spatial model but for rounding, else one line.
std::string why_not_exact(Model model, const Problem& problem);

/// The model of least work whose results are proven to be those of the spatial model but for rounding: that one, if no other.
Model smallest_exact(const Problem& problem);

/// "body \"b\", element 12 starts with uy = 0.1 m" for the first element whose start has one of these fields, or an empty text.
std::string start_with(const Problem& problem, std::initializer_list<Field> fields);

/// "load 0 has force y = 2 N", or an empty text.
/// @param forces, torques  the axes that count
std::string load_along(const Problem& problem, std::initializer_list<int> forces, std::initializer_list<int> torques);

/// "gravity or base acceleration acts along z", or an empty text.
std::string acceleration_along(const Problem& problem, std::initializer_list<int> axes);

/// "body \"plate\" is more than one element thick in z", or "extra link 0 between elements 1 and 2 is along z", or an empty text.
std::string thickness_in_z(const Problem& problem);

} // namespace dss
