#pragma once

#include <filesystem>

namespace nightjar::test {

/// The scene that the scenarios fly in.
inline std::filesystem::path arena() {
  return std::filesystem::path(NIGHTJAR_SOURCE_DIR) / "models" / "arena.xml";
}

}  // namespace nightjar::test
