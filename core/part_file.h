#pragma once

#include <filesystem>
#include <fstream>
#include <ostream>

namespace nightjar::core {

/// What a file is called until it is complete: NAME.part.EXT. The extension stays at the
/// end, for it tells some writers which format to use.
std::filesystem::path part_name(std::filesystem::path path);

/// A file that has its name only once it is complete. Until then it is called
/// NAME.part.EXT, or NAME.part2.EXT and so on where there is such a file already: what
/// others have put there stays as it is.
class PartFile {
 public:
  /// Throws std::invalid_argument when the folder does not exist or cannot be
  /// written, or when `path` is there and not a plain file.
  explicit PartFile(std::filesystem::path path);

  /// Removes what was not finished.
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  /// Where to write, bytes as they are.
  std::ostream& stream() { return out_; }

  /// Gives the file its name, instead of an older one. Nothing may be written
  /// afterwards. Throws std::runtime_error when the disk did not take all of it.
  void finish();

  /// Throws std::runtime_error when the disk did not take what was written so far.
  void check() const;

 private:
  std::filesystem::path path_;
  std::filesystem::path part_;  ///< Empty once it has its name.
  std::ofstream out_;
};

}  // namespace nightjar::core
