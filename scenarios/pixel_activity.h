#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/event.h"
#include "core/image.h"

namespace nightjar::scenarios {

/// What a pixel's events are taken for; see classify_pixels().
enum class PixelKind : std::uint8_t { signal, quiet, hot };

/// What each pixel of an event sensor did, be it simulated or real.
struct PixelActivity {
  double duration_s = 0;
  core::Image<std::uint32_t> events;
  core::Image<std::uint32_t> on_events;
  core::Image<PixelKind> kinds;
  /// Times between neighbouring events of one pixel, of all pixels but the hot ones,
  /// ascending.
  std::vector<std::int64_t> intervals_us;

  core::Resolution size() const { return events.size(); }
};

/// Sorts pixels by their numbers of events alone, so that one rule serves a sensor at
/// rest and a recording of a moving scene.
///
/// Hot: fires at 20 Hz at least, 12 times at least, and more than 4 times as often as
/// all of its 8 neighbours but one (which may be hot, too). An edge that passes leaves
/// a line of pixels, never one alone.
///
/// Quiet: no hot pixel, and its neighbours up to 4 px away (9x9), the hot ones
/// aside, are as calm as noise is. A pixel's own events have no say, so that the rate
/// of the quiet ones is not biased. The calmest tenth of the pixels, by their
/// neighbours, gives the noise's rate; the neighbours may then have up to the 99 %
/// quantile of Poisson noise 4 times as strong (v2e's shot noise is 3.8 times as strong
/// for a black pixel as for a white one). Where less than a tenth of the picture is at
/// rest, "quiet" means no more than "the calmest part".
///
/// Signal: the rest.
core::Image<PixelKind> classify_pixels(const core::Image<std::uint32_t>& events, double duration_s);

/// The activity in (begin, end]; the first event may lie at `begin`.
/// Throws std::invalid_argument for an empty sensor or stretch of time, and for an event
/// that lies outside of either or is earlier than the one before.
PixelActivity pixel_activity(std::span<const core::Event> events, core::Resolution size,
                             core::Time begin, core::Time end);

}  // namespace nightjar::scenarios
