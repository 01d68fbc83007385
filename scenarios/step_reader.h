#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/event.h"
#include "msg/bus.h"

namespace nightjar::scenarios {

/// A recording cut into steps, as a source would send them.
class StepReader {
 public:
  virtual ~StepReader() = default;

  /// Publishes the next step's messages, its event packet last, and returns the packet's
  /// end; nothing at the end. Throws std::invalid_argument for what cannot be read on from.
  virtual std::optional<core::Time> next(msg::Bus& bus) = 0;

  /// Whether there are vehicle states, without which the tracker has nothing to say.
  virtual bool has_vehicle_states() const = 0;

  /// Share of the file that has been read, 0 to 1.
  virtual double progress() const = 0;

  /// What was not as it should be so far and was passed over, in one line; empty if nothing.
  virtual std::string faults() const = 0;
};

/// Opens our own log (`nightjar run --record-events`), what lcm-logger wrote of our
/// processes, or a camera's recording (camera::open_recording, which `size` goes to), which
/// is cut every 10 ms from its first event on. Throws std::invalid_argument, naming the
/// file, when it cannot be read or holds no events.
std::unique_ptr<StepReader> open_steps(const std::filesystem::path& path,
                                       std::optional<core::Resolution> size = std::nullopt);

}  // namespace nightjar::scenarios
