#include "scenarios/recording_info.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

namespace nightjar::scenarios {
namespace {

void extend(std::optional<RecordingInfo::Span>& span, core::Time first, core::Time last) {
  if (!span) span = RecordingInfo::Span{first, last};
  span->last = std::max(span->last, last);
}

void take_frame(const camera::RecordedFrame& frame, RecordingInfo& info) {
  const core::Time exposure = frame.exposure_end - frame.exposure_begin;
  if (info.frames++ == 0) {
    info.frame_size = frame.gray.size();
    info.frame_bits = frame.bits;
    info.least_exposure = info.most_exposure = exposure;
  }
  info.least_exposure = std::min(info.least_exposure, exposure);
  info.most_exposure = std::max(info.most_exposure, exposure);
  extend(info.exposures, frame.exposure_begin, frame.exposure_end);
}

void take_part(const camera::RecordingPart& part, RecordingInfo& info) {
  const auto on = static_cast<std::uint64_t>(std::ranges::count_if(part.events, &core::Event::on));
  info.events_on += on;
  info.events_off += part.events.size() - on;
  if (!part.events.empty()) extend(info.events, part.events.front().t, part.events.back().t);
  for (const camera::RecordedFrame& frame : part.frames) take_frame(frame, info);
  info.imu_samples += part.imu.size();
  if (!part.imu.empty()) extend(info.imu, part.imu.front().t, part.imu.back().t);
  info.triggers += part.triggers.size();
}

/// Of `count` things evenly spread, the first and the last at the span's ends.
double rate_hz(std::uint64_t count, const std::optional<RecordingInfo::Span>& span) {
  if (!span || count < 2 || span->first == span->last) return 0;
  return static_cast<double>(count - 1) / span->duration_s();
}

nlohmann::ordered_json json_of(const std::optional<RecordingInfo::Span>& span) {
  if (!span) return nullptr;
  return {{"first_us", span->first.count()},
          {"last_us", span->last.count()},
          {"duration_s", span->duration_s()}};
}

nlohmann::ordered_json json_of(const camera::RecordingFaults& faults) {
  return {{"bytes_lost", faults.bytes_lost},
          {"packets_unknown", faults.packets_unknown},
          {"packets_damaged", faults.packets_damaged},
          {"events_outside", faults.events_outside},
          {"events_backwards", faults.events_backwards},
          {"time_resets", faults.time_resets},
          {"first", faults.first}};
}

std::string row(const char* name, const std::string& value) {
  return fmt::format("  {:<10}{}\n", name, value);
}

std::string seconds_text(core::Time t) {
  return fmt::format("{}.{:06}", t.count() / 1'000'000, t.count() % 1'000'000);
}

std::string events_text(const RecordingInfo& info) {
  return fmt::format("{} ({} ON, {} OFF), {:.1f} k/s", info.events_on + info.events_off,
                     info.events_on, info.events_off, info.event_rate_hz() / 1000);
}

std::string frames_text(const RecordingInfo& info) {
  const std::string shape =
      fmt::format("{} of {}x{} px, {} bits", info.frames, info.frame_size.width_px,
                  info.frame_size.height_px, info.frame_bits);
  return fmt::format("{}, {:.1f} Hz, exposed {} to {} us", shape,
                     rate_hz(info.frames, info.exposures), info.least_exposure.count(),
                     info.most_exposure.count());
}

}  // namespace

double RecordingInfo::event_rate_hz() const {
  if (!events || events->first == events->last) return 0;
  return static_cast<double>(events_on + events_off) / events->duration_s();
}

RecordingInfo inspect(camera::RecordingReader& recording,
                      const std::function<void(double share)>& on_progress) {
  RecordingInfo info;
  info.format = recording.format();
  info.camera = recording.camera();
  info.size = recording.size();
  for (camera::RecordingPart part; recording.next(part);) {
    take_part(part, info);
    on_progress(recording.progress());
  }
  info.faults = recording.faults();
  info.others = recording.others();
  return info;
}

std::string to_json(const RecordingInfo& info) {
  nlohmann::ordered_json frames = nullptr, imu = nullptr;
  if (info.frames > 0)
    frames = {{"count", info.frames},
              {"width_px", info.frame_size.width_px},
              {"height_px", info.frame_size.height_px},
              {"bits", info.frame_bits},
              {"rate_hz", rate_hz(info.frames, info.exposures)},
              {"least_exposure_us", info.least_exposure.count()},
              {"most_exposure_us", info.most_exposure.count()},
              {"time", json_of(info.exposures)}};
  if (info.imu_samples > 0)
    imu = {{"count", info.imu_samples},
           {"rate_hz", rate_hz(info.imu_samples, info.imu)},
           {"time", json_of(info.imu)}};
  const nlohmann::ordered_json json = {{"format", info.format},
                                       {"camera", info.camera},
                                       {"width_px", info.size.width_px},
                                       {"height_px", info.size.height_px},
                                       {"events",
                                        {{"count", info.events_on + info.events_off},
                                         {"on", info.events_on},
                                         {"off", info.events_off},
                                         {"rate_hz", info.event_rate_hz()},
                                         {"time", json_of(info.events)}}},
                                       {"frames", frames},
                                       {"imu", imu},
                                       {"triggers", info.triggers},
                                       {"others", info.others},
                                       {"faults", json_of(info.faults)}};
  return json.dump(2) + '\n';
}

std::string to_table(const RecordingInfo& info) {
  std::string table = row("format", info.format);
  table += row("sensor", fmt::format("{}x{} px{}{}", info.size.width_px, info.size.height_px,
                                     info.camera.empty() ? "" : ", ", info.camera));
  table += row("events", events_text(info));
  if (info.events) {
    table += row("first", seconds_text(info.events->first) + " s");
    table += row("last", seconds_text(info.events->last) + " s");
    table += row("duration", fmt::format("{:.6f} s", info.events->duration_s()));
  }
  table += row("frames", info.frames > 0 ? frames_text(info) : "none");
  table += row("IMU", info.imu_samples > 0 ? fmt::format("{} samples, {:.1f} Hz", info.imu_samples,
                                                         rate_hz(info.imu_samples, info.imu))
                                           : "none");
  table += row("triggers", info.triggers > 0 ? std::to_string(info.triggers) : "none");
  for (const auto& [channel, messages] : info.others)
    table += row("besides", fmt::format("{} messages {}", messages, channel));
  return table + row("faults", info.faults.any() ? fault_text(info.faults) : "none");
}

std::string fault_text(const camera::RecordingFaults& faults) {
  if (!faults.any()) return {};
  std::vector<std::string> counts;
  const auto add = [&](std::uint64_t count, const char* what) {
    if (count > 0) counts.push_back(fmt::format("{} {}", count, what));
  };
  add(faults.bytes_lost, "bytes lost");
  add(faults.packets_unknown, "packets of unknown type");
  add(faults.packets_damaged, "damaged packets");
  add(faults.events_outside, "events or frames off the sensor");
  add(faults.events_backwards, "out of order");
  add(faults.time_resets, "resets of the clock");
  if (counts.empty()) return faults.first;
  return fmt::format("{}; first: {}", fmt::join(counts, ", "), faults.first);
}

}  // namespace nightjar::scenarios
