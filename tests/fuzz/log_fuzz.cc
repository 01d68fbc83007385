// LCM logs: the log itself, and the messages in it, which are put together here so that their
// types' fingerprints need not be guessed.
#include <fuzzer/FuzzedDataProvider.h>

#include <algorithm>
#include <vector>

#include "msg/channels.h"
#include "msg/event_parts.h"
#include "scenarios/log_recording.h"
#include "tests/fuzz/recording_fuzz.h"

namespace {

using namespace nightjar;

constexpr core::Resolution kSensor{4, 3};

/// Sound messages of every kind that a recording is made of, to be changed a little.
std::vector<msg::Message> sound_messages() {
  const core::EventPacket packet{core::Time(0), core::Time(9), {{core::Time(3), 1, 2, true}}};
  const core::ApsFrame frame{core::Time(1), core::Time(5), 8, core::Image<std::uint16_t>({2, 2})};
  core::ImuSample sample;
  sample.t = core::Time(4);
  msg::StepMark mark{core::Time(9), 1, 2, core::Time(3), true, {{"A", 1}}, "source"};
  return {{msg::kSensor.name, msg::encode(msg::SensorNote{{}, kSensor, "D"})},
          {msg::kEvents.name, msg::encode(packet)},
          {msg::kEventParts, msg::cut_events(msg::encode(packet), 3).front()},
          {msg::kApsReadout.name, msg::encode(msg::ReadoutNote{core::Time(5), {}, {}, 1, 1})},
          {msg::kApsFrame.name, msg::encode(frame)},
          {msg::kImuTemperature.name, msg::encode(msg::TemperatureNote{core::Time(4), 20})},
          {msg::kImu.name, msg::encode(sample)},
          {msg::kTrigger.name, msg::encode(msg::TriggerNote{core::Time(2), 4})},
          {msg::kPicture.name,
           msg::encode(core::Picture{core::Time(9), core::Image<std::uint8_t>(kSensor)})},
          {msg::kStep.name, msg::encode(mark)}};
}

void append(std::string& bytes, std::uint64_t value, int count) {
  for (int shift = 8 * count - 8; shift >= 0; shift -= 8)
    bytes += static_cast<char>(value >> shift);
}

std::string any_log(FuzzedDataProvider& data) {
  static const std::vector<msg::Message> kSound = sound_messages();
  std::string log;
  while (data.remaining_bytes() > 0) {
    msg::Message message = data.ConsumeIntegralInRange(0, 7) == 0
                               ? kSound[0]
                               : kSound[data.ConsumeIntegralInRange<std::size_t>(0, 9)];
    for (int changes = data.ConsumeIntegralInRange(0, 3); changes > 0; --changes)
      message.bytes[data.ConsumeIntegralInRange<std::size_t>(0, message.bytes.size() - 1)] =
          data.ConsumeIntegral<std::uint8_t>();
    if (data.ConsumeIntegralInRange(0, 7) == 0)
      message.bytes.resize(data.ConsumeIntegralInRange<std::size_t>(0, 2 * message.bytes.size()));
    append(log, data.ConsumeIntegralInRange(0, 31) == 0 ? 7 : 0xeda1da01, 4);
    for (int number = 0; number < 2; ++number) append(log, 0, 8);  // and time, which nobody reads
    append(log, message.channel.size(), 4);
    append(log, data.ConsumeIntegralInRange(0, 31) == 0 ? 1u << 30 : message.bytes.size(), 4);
    log += message.channel;
    log.append(message.bytes.begin(), message.bytes.end());
  }
  return log;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  FuzzedDataProvider data(bytes, size);
  std::string log = data.ConsumeBool() ? any_log(data) : data.ConsumeRemainingBytesAsString();
  return fuzz::read_opened(kSensor, [&] {
    return std::make_unique<scenarios::LogRecording>(
        msg::LogReader(std::make_unique<std::istringstream>(std::move(log)), "fuzz"), kSensor);
  });
}
