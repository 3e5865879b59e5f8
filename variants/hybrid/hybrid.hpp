#pragma once
#include "variants/api.hpp"

namespace dss {

/// The executor of the variant `hybrid`, members as Setup says. @throws InputError: what is wrong with them
std::unique_ptr<Executor> create_hybrid(const Setup& setup);

} // namespace dss
