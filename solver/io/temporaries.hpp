#pragma once
/// Temporary files of this process: made under names that nobody can guess, and removed when a
/// signal ends the process.
#include <string>

namespace dss {

/// Creates a file that did not exist, and opens it for writing.
/// @param pattern  its name, with XXXXXX in place of random letters; receives the name
/// @param mode  permissions, before the umask
/// @return the descriptor, or -1 with errno
int make_temporary(std::string& pattern, unsigned mode);

/// Adds a file that exists: it is removed too if a signal ends the process.
void remember_temporary(const std::string& path);

/// Ends the care for a file that was removed or renamed.
void forget_temporary(const std::string& path);

/// Removes all temporary files. May be called in a signal handler.
void remove_temporaries();

} // namespace dss
