#include "solver/model/file_digest.hpp"

#include "solver/digest.hpp"
#include "solver/lattice/shape_digest.hpp"

namespace dss {

std::string file_digest(const Problem& problem) {
  const std::string materials(problem.materials.begin(), problem.materials.end());
  return text_digest(shape_digest(problem.lattice) + series_digest(problem) + materials);
}

} // namespace dss
