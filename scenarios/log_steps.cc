#include "scenarios/log_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <stdexcept>
#include <utility>

#include "msg/event_parts.h"
#include "scenarios/process_roles.h"

namespace nightjar::scenarios {
namespace {

constexpr std::size_t kMostWaiting = 10'000;  // messages of a step, pieces of its events

bool is_from_source(const std::string& channel) {
  return std::ranges::find(kFromSource.channels, channel) != kFromSource.channels.end();
}

}  // namespace

LogSteps::LogSteps(const std::filesystem::path& path) : log_(path) {
  if (!read_step())
    throw std::invalid_argument(
        fmt::format("{}: holds no events, see nightjar run --record-events", path.string()));
}

void LogSteps::count(std::uint64_t camera::RecordingFaults::*what, std::uint64_t amount,
                     const std::string& why) {
  faults_.*what += amount;
  if (faults_.first.empty())
    faults_.first = fmt::format("{}: byte {}: message: {}", log_.name(), log_.offset(), why);
}

void LogSteps::count_lost() {
  const std::uint64_t new_ones = log_.bytes_lost() - faults_.bytes_lost;
  if (new_ones > 0)
    count(&camera::RecordingFaults::bytes_lost, new_ones,
          fmt::format("{} bytes before it are damaged", new_ones));
}

/// Lets go what has waited for its events for so long that no memory would hold it.
template <class T>
void LogSteps::make_room(std::vector<T>& waiting) {
  if (waiting.size() < kMostWaiting) return;
  count(&camera::RecordingFaults::packets_damaged, waiting.size(),
        fmt::format("{} before it have no events", waiting.size()));
  waiting.clear();
}

bool LogSteps::decodes(const msg::Bytes& packet) {
  try {
    (void)msg::decode<core::EventPacket>(packet);
    return true;
  } catch (const std::invalid_argument& error) {
    count(&camera::RecordingFaults::packets_damaged, 1, error.what());
    return false;
  }
}

void LogSteps::take_part(msg::Bytes part) {
  try {
    msg::join_events(std::span(&part, 1));
  } catch (const std::invalid_argument& error) {
    count(&camera::RecordingFaults::packets_damaged, 1, error.what());
    return;
  }
  make_room(parts_);
  parts_.push_back(std::move(part));
}

/// Whether there was a packet to close the step with.
bool LogSteps::close_with(std::vector<msg::Bytes> packets) {
  bool closed = false;
  for (msg::Bytes& packet : packets) {
    if (!decodes(packet)) continue;
    step_.push_back({msg::kEvents.name, std::move(packet)});
    closed = true;
  }
  return closed;
}

/// Whether the step is whole with `message`. A packet in pieces is when its sender closes the
/// step.
bool LogSteps::take(msg::Message message) {
  if (message.channel == msg::kEventParts) {
    take_part(std::move(message.bytes));
  } else if (message.channel == msg::kStep.name) {
    return close_with(msg::join_events(std::exchange(parts_, {})));
  } else if (message.channel == msg::kEvents.name) {
    std::vector<msg::Bytes> packet;
    packet.push_back(std::move(message.bytes));
    return close_with(std::move(packet));
  } else if (is_from_source(message.channel)) {
    make_room(step_);
    step_.push_back(std::move(message));
  }
  return false;
}

bool LogSteps::read_step() {
  step_.clear();
  while (auto message = log_.next()) {
    count_lost();
    if (!repeats_.is_repeat(*message) && take(std::move(*message))) return true;
  }
  count_lost();
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
