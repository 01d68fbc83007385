#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/image.h"
#include "esi/config.h"
#include "esi/quality.h"

namespace nightjar::scenarios {

/// How like the reference the picture is that one method makes of a recording.
struct MethodScore {
  std::string method;
  std::optional<esi::Quality> quality;
  std::string skipped;  ///< Why there is none.
};

struct MethodScoresOptions {
  esi::ReconstructorConfig reconstructor;  ///< Its method does not matter.
  std::vector<esi::Method> methods;
  double rate_hz = 100;           ///< Of pictures: how networks advance.
  std::optional<double> until_s;  ///< Where to compare; at the last event by default.
};

/// Compares each method's picture at the end of the recording, or at options.until_s, with
/// `reference`, whose size the recording has to have. A network without weights is skipped,
/// and so is a method that starts from frames where the recording holds none: the reference
/// would be its own input. Throws std::invalid_argument as reconstruct() does.
std::vector<MethodScore> score_methods(const std::filesystem::path& recording,
                                       const core::Image<std::uint8_t>& reference,
                                       const MethodScoresOptions& options);

/// For people and for scripts.
std::string to_table(const std::vector<MethodScore>& scores);
std::string to_json(const std::vector<MethodScore>& scores);

}  // namespace nightjar::scenarios
