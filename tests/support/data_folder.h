#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>

namespace nightjar::test {

/// The folder of real recordings, which are not part of the project: NIGHTJAR_DATA,
/// else `shared/data` beside the checkout. Nothing where neither exists: skip the test.
inline std::optional<std::filesystem::path> data_folder() {
  const char* set = std::getenv("NIGHTJAR_DATA");
  const std::filesystem::path folder =
      set != nullptr ? std::filesystem::path(set)
                     : std::filesystem::path(NIGHTJAR_SOURCE_DIR) / ".." / "shared" / "data";
  return std::filesystem::is_directory(folder) ? std::optional(folder) : std::nullopt;
}

}  // namespace nightjar::test
