#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace nightjar::scenarios {

/// The files a run leaves; the summary comes last.
inline constexpr std::string_view kScenarioFile = "scenario.yaml";
inline constexpr std::string_view kEstimatesFile = "estimates.csv";
inline constexpr std::string_view kLogFile = "run.lcm";
inline constexpr std::string_view kVideoFile = "run.mp4";
inline constexpr std::string_view kSummaryFile = "summary.json";

/// Creates the folder where needed; whether it was. Throws std::invalid_argument, in one
/// line, when the path is a file or cannot be created.
bool create_output_folder(const std::filesystem::path& folder);

/// The folder of a run's results. A file is called NAME.part.EXT until it is
/// complete, and summary.json appears after all others: a folder that has it
/// holds a whole run.
class OutputFolder {
 public:
  /// Creates the folder where needed and removes an earlier run's files, these
  /// five and their parts only. Throws std::invalid_argument, in one line, when
  /// the path is a file or cannot be written.
  explicit OutputFolder(std::filesystem::path folder);

  /// Removes the parts that were never completed.
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Where the complete file `name` lies.
  std::filesystem::path path(std::string_view name) const;

  /// Where to write `name` while it is not complete.
  std::filesystem::path part(std::string_view name) const;

  /// Gives a part its own name. Throws std::runtime_error when there is no such
  /// part, and for summary.json as long as another part is left.
  void complete(std::string_view name);

  /// Writes a whole file by way of its part. Throws std::runtime_error when the
  /// disk does not take it.
  void write(std::string_view name, std::string_view text);

 private:
  void check_all_complete() const;

  std::filesystem::path folder_;
};

}  // namespace nightjar::scenarios
