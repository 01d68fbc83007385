#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/image.h"
#include "core/part_file.h"
#include "core/state.h"
#include "scenarios/gray_video.h"

namespace nightjar::scenarios {

/// The folder that `nightjar reconstruct` fills:
///
///     picture_000001.png, ...   or all of them as pictures.mp4
///     times.csv                 picture,time_us
///     tags.csv                  time_us,id,hamming,decision_margin,corners_px
///     summary.json              last: a folder that has it is whole
///
/// `corners_px` is x and y of the four corners in core::TagDetection's order, eight numbers
/// with blanks between.
class ReconstructionFolder {
 public:
  struct Options {
    bool video = false;
    bool tags = false;
    core::Resolution size;  ///< Of the pictures.
    double rate_hz = 100;
  };

  /// Creates the folder where needed and removes an earlier result, files of these names
  /// only. Throws std::invalid_argument when the path is a file or cannot be written,
  /// std::runtime_error when no video can be.
  ReconstructionFolder(std::filesystem::path folder, const Options& options);

  /// Removes all it has written unless it was finished, the folder too where it made it.
  ~ReconstructionFolder();
  ReconstructionFolder(const ReconstructionFolder&) = delete;
  ReconstructionFolder& operator=(const ReconstructionFolder&) = delete;

  /// Pictures in the order of their times. Throws std::runtime_error when the disk does not
  /// take it.
  void add(const core::Picture& picture, std::span<const core::TagDetection> tags);

  /// Completes all files, `summary` as summary.json at the end. Throws std::runtime_error
  /// when the disk does not take it.
  void finish(const std::string& summary);

 private:
  void remove_results() const;
  void add_tags(std::span<const core::TagDetection> tags);

  std::filesystem::path folder_;
  bool is_new_;
  bool finished_ = false;
  std::uint64_t pictures_ = 0;
  std::optional<core::PartFile> times_, tags_;
  std::optional<GrayVideo> video_;
};

}  // namespace nightjar::scenarios
