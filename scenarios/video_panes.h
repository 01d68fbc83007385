#pragma once

#include <span>
#include <string>

#include "core/image.h"
#include "sim/chase_view.h"

namespace nightjar::scenarios {

/// A picture of people's size that a video frame is put together from.
using Pane = core::Image<sim::Rgb>;

/// Sensor pixels become squares of this many pixels.
inline constexpr int kPaneScale = 2;

/// Grey levels as they are, enlarged; black when the picture is empty.
Pane gray_pane(const core::Image<std::uint8_t>& gray, core::Resolution sensor);

/// A frame of the active pixels as 8-bit grey levels.
core::Image<std::uint8_t> gray_8_bit(const core::ApsFrame& frame);

/// Where events were: red brighter, green darker (as the ESI paper draws them).
Pane event_pane(std::span<const core::Event> events, core::Resolution sensor);

}  // namespace nightjar::scenarios
