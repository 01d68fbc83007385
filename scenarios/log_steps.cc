#include "scenarios/log_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "msg/event_parts.h"
#include "scenarios/process_roles.h"

namespace nightjar::scenarios {
namespace {

bool is_from_source(const std::string& channel) {
  return std::ranges::find(kFromSource.channels, channel) != kFromSource.channels.end();
}

}  // namespace

LogSteps::LogSteps(const std::filesystem::path& path) : log_(path) {
  if (!read_step())
    throw std::invalid_argument(
        fmt::format("{}: holds no events, see nightjar run --record-events", path.string()));
}

/// A packet in pieces is whole when the next one begins or its sender closes the step.
bool LogSteps::close_with(std::vector<msg::Bytes> packets) {
  for (msg::Bytes& packet : packets) step_.push_back({msg::kEvents.name, std::move(packet)});
  return !packets.empty();
}

bool LogSteps::read_step() {
  step_.clear();
  while (auto message = log_.next()) {
    if (repeats_.is_repeat(*message)) continue;
    if (message->channel == msg::kEventParts) {
      parts_.push_back(std::move(message->bytes));
    } else if (message->channel == msg::kStep.name) {
      if (close_with(msg::join_events(std::exchange(parts_, {})))) return true;
    } else if (is_from_source(message->channel)) {
      step_.push_back(std::move(*message));
      if (step_.back().channel == msg::kEvents.name) return true;
    }
  }
  step_.clear();  // a step without its events is not whole
  return false;
}

bool LogSteps::has_vehicle_states() const {
  return std::ranges::find(step_, msg::kVehicleState.name, &msg::Message::channel) != step_.end();
}

std::optional<core::Time> LogSteps::next(msg::Bus& bus) {
  if (step_.empty()) return std::nullopt;
  for (const msg::Message& message : step_) bus.publish_bytes(message.channel, message.bytes);
  const core::Time end = msg::message_time(step_.back().bytes);
  read_step();
  return end;
}

}  // namespace nightjar::scenarios
