#pragma once

#include <cstdint>
#include <string>

#include "camera/recording.h"
#include "core/image.h"

namespace nightjar::scenarios {

/// What came of a recording.
struct Reconstruction {
  std::string method;
  core::Resolution size;
  double rate_hz = 0;
  core::Time begin{}, end{};  ///< The first event and the last; the window, where cut.
  std::uint64_t events = 0;
  std::uint64_t frames = 0;          ///< Of the active pixels, used.
  std::uint64_t frames_refused = 0;  ///< Unfit, so left out.
  std::string first_refusal;         ///< Why, of the first.
  std::uint64_t pictures = 0;
  std::uint64_t pictures_left_out = 0;  ///< Where nothing happened for more than a minute.
  bool searched = false;                ///< For tags.
  std::uint64_t pictures_with_tag = 0;
  std::uint64_t tags = 0;
  double wall_time_s = 0;
  camera::RecordingFaults faults;
  core::Picture last;  ///< At `end`, whether a picture was due or not.

  double duration_s() const { return core::seconds(end - begin); }
};

/// For people, for scripts, and one line on what could not be used, empty when all was.
std::string to_table(const Reconstruction& result);
std::string to_json(const Reconstruction& result);
std::string warning(const Reconstruction& result);

}  // namespace nightjar::scenarios
