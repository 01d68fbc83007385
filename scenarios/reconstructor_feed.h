#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <string>

#include "core/event.h"
#include "core/image.h"
#include "esi/reconstructor.h"

namespace nightjar::scenarios {

/// Hands events and frames to a reconstructor in the order that
/// esi::Reconstructor::add_frame() asks for, whichever came first: a frame follows the
/// events up to the end of its exposure. One that comes later than that acts at once.
class ReconstructorFeed {
 public:
  explicit ReconstructorFeed(esi::Reconstructor& reconstructor) : reconstructor_(reconstructor) {}

  /// Held back until advance() reaches its end. Frames come in the order they were taken;
  /// of more than 10 bits, which a recording may have, the upper 10 are used.
  void add_frame(core::ApsFrame frame);

  /// Takes the events since the call before, all up to `until` included, and the frames that
  /// end by then. Throws std::invalid_argument as Reconstructor::process() does; a frame
  /// that the reconstructor refuses is dropped and counted.
  void advance(std::span<const core::Event> events, core::Time until);

  std::uint64_t frames() const { return frames_taken_; }
  std::uint64_t frames_refused() const { return frames_refused_; }
  /// Why the first of them was refused, else empty.
  const std::string& first_refusal() const { return first_refusal_; }

 private:
  void hand_over(core::ApsFrame&& frame);

  esi::Reconstructor& reconstructor_;
  std::deque<core::ApsFrame> frames_;
  std::uint64_t frames_taken_ = 0;
  std::uint64_t frames_refused_ = 0;
  std::string first_refusal_;
};

}  // namespace nightjar::scenarios
