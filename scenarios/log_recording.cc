#include "scenarios/log_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <stdexcept>
#include <utility>

#include "camera/printable_text.h"
#include "msg/channels.h"
#include "msg/event_parts.h"

namespace nightjar::scenarios {
namespace {

constexpr std::size_t kMostNameLength = 100;
constexpr std::size_t kMostOtherChannels = 100;

// A part is handed over once it has events, or this many of the rest.
constexpr std::size_t kMostFrames = 8;
constexpr std::size_t kMostSamples = 10'000;

bool is_full(const camera::RecordingPart& part) {
  return !part.events.empty() || part.frames.size() >= kMostFrames ||
         part.imu.size() + part.triggers.size() >= kMostSamples;
}

/// What a message tells of the sensor, if it does.
std::optional<msg::SensorNote> sensor_in(const msg::Message& message) {
  msg::SensorNote sensor;
  try {
    if (message.channel == msg::kSensor.name)
      sensor = msg::decode<msg::SensorNote>(message.bytes);
    else if (message.channel == msg::kPicture.name)
      sensor.size = msg::decode<core::Picture>(message.bytes).gray.size();
    else if (message.channel == msg::kApsFrame.name)
      sensor.size = msg::decode<core::ApsFrame>(message.bytes).gray.size();
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
  const auto [least, greatest] = std::minmax(sensor.size.width_px, sensor.size.height_px);
  if (least < 1 || greatest > core::kMostSide_px) return std::nullopt;
  return sensor;
}

msg::SensorNote find_sensor(msg::LogReader& log, std::optional<core::Resolution> size) {
  std::optional<msg::SensorNote> sensor;
  for (auto message = log.next(); message && !sensor; message = log.next())
    sensor = sensor_in(*message);
  log.rewind();
  if (!sensor && !size)
    throw std::invalid_argument(
        fmt::format("{}: does not tell the sensor's size: it has to be given", log.name()));
  if (!sensor) sensor = msg::SensorNote{{}, *size, {}};
  if (size && *size != sensor->size)
    throw std::invalid_argument(fmt::format("{}: says {}x{} px, expected {}x{}", log.name(),
                                            sensor->size.width_px, sensor->size.height_px,
                                            size->width_px, size->height_px));
  sensor->camera = camera::printable_text(sensor->camera, kMostNameLength);
  return *sensor;
}

}  // namespace

LogRecording::LogRecording(msg::LogReader log, std::optional<core::Resolution> size)
    : log_(std::move(log)), sensor_(find_sensor(log_, size)), intake_(sensor_.size) {
  intake_.set_place(
      [this] { return fmt::format("{}: byte {}: message", log_.name(), log_.offset()); });
}

bool LogRecording::next(camera::RecordingPart& part) {
  part.clear();
  while (!is_full(part)) {
    const auto message = log_.next();
    count_lost();
    if (!message) break;
    take(*message, part);
  }
  return !part.empty();
}

void LogRecording::count_lost() {
  const std::uint64_t new_ones = log_.bytes_lost() - intake_.faults().bytes_lost;
  if (new_ones > 0)
    intake_.fault(&camera::RecordingFaults::bytes_lost,
                  fmt::format("{} bytes before it are damaged", new_ones), new_ones);
}

void LogRecording::take(const msg::Message& message, camera::RecordingPart& part) {
  if (repeats_.is_repeat(message)) return;
  try {
    decode(message, part);
  } catch (const std::invalid_argument& error) {
    intake_.fault(&camera::RecordingFaults::packets_damaged, error.what());
  }
}

void LogRecording::decode(const msg::Message& message, camera::RecordingPart& part) {
  const std::string& channel = message.channel;
  if (channel == msg::kEvents.name) {
    take_events(message.bytes, part);
  } else if (channel == msg::kEventParts) {
    for (const msg::Bytes& packet : msg::join_events(std::span(&message.bytes, 1)))
      take_events(packet, part);
  } else if (channel == msg::kApsFrame.name) {
    take_frame(message.bytes, part);
  } else if (channel == msg::kImu.name) {
    take_imu(message.bytes, part);
  } else if (channel == msg::kTrigger.name) {
    const auto trigger = msg::decode<msg::TriggerNote>(message.bytes);
    intake_.add(camera::Trigger{trigger.t, trigger.type}, part);
  } else if (channel == msg::kApsReadout.name) {
    readout_ = msg::decode<msg::ReadoutNote>(message.bytes);
  } else if (channel == msg::kImuTemperature.name) {
    temperature_ = msg::decode<msg::TemperatureNote>(message.bytes);
  } else if (channel != msg::kSensor.name && channel != msg::kStep.name) {
    count_other(channel);
  }
}

void LogRecording::take_events(const msg::Bytes& packet, camera::RecordingPart& part) {
  for (const core::Event& event : msg::decode<core::EventPacket>(packet).events)
    intake_.add(event, part);
}

void LogRecording::take_frame(const msg::Bytes& bytes, camera::RecordingPart& part) {
  const auto readout = std::exchange(readout_, std::nullopt);
  camera::RecordedFrame frame{msg::decode<core::ApsFrame>(bytes)};
  if (frame.gray.empty()) throw std::invalid_argument("aps_frame_t: no pixels");
  frame.frame_begin = frame.exposure_begin;
  frame.frame_end = frame.exposure_end;
  if (readout && readout->t == frame.exposure_end) {
    frame.frame_begin = readout->frame_begin;
    frame.frame_end = readout->frame_end;
    frame.left_px = readout->left_px;
    frame.top_px = readout->top_px;
  }
  intake_.add(std::move(frame), part);
}

void LogRecording::take_imu(const msg::Bytes& bytes, camera::RecordingPart& part) {
  const auto temperature = std::exchange(temperature_, std::nullopt);
  camera::RecordedImu sample{msg::decode<core::ImuSample>(bytes)};
  if (temperature && temperature->t == sample.t) sample.temperature_c = temperature->temperature_c;
  intake_.add(sample, part);
}

void LogRecording::count_other(const std::string& channel) {
  const std::string name = camera::printable_text(channel);
  const bool known = others_.contains(name) || others_.size() < kMostOtherChannels;
  ++others_[known ? name : "of other channels"];
}

}  // namespace nightjar::scenarios
