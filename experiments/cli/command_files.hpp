#pragma once
/// The files that a command reads and writes. No output may replace an input or another output.
#include "solver/scene/scene_text.hpp"

#include <string>
#include <vector>

namespace dss {

/// Collects the files of one command before it starts. Empty paths and "-" (standard output) are
/// left out.
class CommandFiles {
public:
  /// A file that the command reads. `option` names it in messages, such as "--from".
  void read(const std::string& option, const std::string& path);
  /// A scene by name or path, and the voxel files that it names with these overrides.
  /// @throws InputError if there is no such scene
  void read_scene(const std::string& scene, const std::vector<Override>& overrides = {});
  /// A file that the command writes.
  void write(const std::string& option, const std::string& path);
  /// A series: F.vtu stands for F_0000.vtu, F_0001.vtu, ... and F.pvd (see FrameSeries).
  void write_series(const std::string& option, const std::string& path);
  /// The files of an ensemble: F.csv stands for F-NAME.csv of each member.
  void write_members(const std::string& option, const std::string& path);
  /// Devices and pipes may be written twice (/dev/null).
  /// @throws InputError if a file that is written is also read, or written twice
  void require_distinct() const;

private:
  /// One file, or a family of files in one directory.
  struct Entry {
    std::string option, path;
    bool is_written;
    std::string pattern; ///< of the names of a family, as fnmatch reads it; empty for one file
    std::string example; ///< the name of a member of the family
  };
  void write_family(const std::string& option, const std::string& path, const std::string& joint,
                    const std::string& any, const std::string& extension);
  static bool is_in_family(const Entry& one, const Entry& family);
  static bool are_one_file(const Entry& one, const Entry& other);

  std::vector<Entry> entries_;
};

/// For a command that reads these files and writes `--json` in the end.
/// @throws InputError if it would replace one of them, or cannot be written
void require_sound_output(CommandFiles inputs, const std::string& json);

/// The same for a command that reads a scene alone, by name or path.
/// @throws InputError if there is no such scene
void require_sound_output(const std::string& scene, const std::vector<Override>& overrides,
                          const std::string& json);

} // namespace dss
