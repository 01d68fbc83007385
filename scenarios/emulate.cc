#include "scenarios/emulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "sim/background_activity_filter.h"
#include "sim/emulator.h"
#include "sim/readout.h"

namespace nightjar::scenarios {
namespace {

constexpr double kWhite = 1.0;  // of the frames

/// The event side of the sensor: no active pixels, for the frames are there already.
class EventSensor {
 public:
  EventSensor(const EmulateOptions& options, core::Resolution size)
      : pixels_(sim::effective_pixel(options.sensor, options.illuminance_lux), size, kWhite,
                options.seed),
        readout_(options.sensor.readout, size),
        filter_(options.sensor.background_activity_filter, size) {}

  /// The events read out since the call before; valid until the next.
  std::span<const core::Event> expose(core::Time t, const core::Image<float>& intensity) {
    requests_.clear();
    events_.clear();
    pixels_.step(t, intensity, requests_);
    readout_.step(t, requests_, events_);
    filter_.filter(events_);
    return events_;
  }

  /// What still waits in the readout at `t`, the time of the last frame.
  std::span<const core::Event> read_rest(core::Time t) {
    events_.clear();
    while (readout_.waiting() > 0) {
      t += std::chrono::seconds(1);
      readout_.step(t, {}, events_);
    }
    filter_.filter(events_);
    return events_;
  }

  const sim::ReadoutCounts& readout_counts() const { return readout_.counts(); }

 private:
  sim::EventEmulator pixels_;
  sim::Readout readout_;
  sim::BackgroundActivityFilter filter_;
  std::vector<core::Event> requests_, events_;
};

double time_s(int frame, double rate_hz) { return frame / rate_hz; }

void count(std::span<const core::Event> events, Emulation& emulation) {
  const auto on = static_cast<std::uint64_t>(std::ranges::count_if(events, &core::Event::on));
  emulation.events_on += on;
  emulation.events_off += events.size() - on;
}

[[noreturn]] void throw_too_few(int frames) {
  throw std::invalid_argument(fmt::format("{} frames could be read, needed at least 2", frames));
}

std::string row(const char* name, const std::string& value) {
  return fmt::format("  {:<12}{}\n", name, value);
}

}  // namespace

Emulation emulate(camera::FrameSource& frames, const EmulateOptions& options,
                  const std::function<void(std::span<const core::Event>)>& take) {
  core::Image<float> intensity;
  if (!frames.next(intensity)) throw_too_few(0);
  EventSensor sensor(options, intensity.size());
  Emulation result;
  result.size = intensity.size();
  if (options.on_start) options.on_start(result.size);
  result.rate_hz = frames.rate_hz();
  result.announced_frames = frames.announced_frames();
  const double end_s = time_s(std::max(0, result.announced_frames - 1), result.rate_hz);
  do {
    result.duration_s = time_s(result.frames++, result.rate_hz);
    const auto events = sensor.expose(core::from_seconds(result.duration_s), intensity);
    count(events, result);
    take(events);
    if (options.on_progress) options.on_progress(result.duration_s, end_s);
  } while (frames.next(intensity));
  if (result.frames < 2) throw_too_few(result.frames);
  const auto rest = sensor.read_rest(core::from_seconds(result.duration_s));
  count(rest, result);
  take(rest);
  result.events_lost = sensor.readout_counts().lost;
  result.max_delay = sensor.readout_counts().max_delay;
  result.bad_values = frames.bad_values();
  result.event_rate_hz =
      static_cast<double>(result.events_on + result.events_off) / result.duration_s;
  return result;
}

std::string to_json(const Emulation& e) {
  const nlohmann::ordered_json json = {
      {"width_px", e.size.width_px},
      {"height_px", e.size.height_px},
      {"fps", e.rate_hz},
      {"frames", e.frames},
      {"announced_frames", e.announced_frames},
      {"duration_s", e.duration_s},
      {"events", e.events_on + e.events_off},
      {"events_on", e.events_on},
      {"events_off", e.events_off},
      {"events_lost", e.events_lost},
      {"max_delay_us", e.max_delay.count()},
      {"event_rate_hz", e.event_rate_hz},
      {"bad_values", e.bad_values},
  };
  return json.dump(2) + '\n';
}

std::string to_table(const Emulation& e) {
  std::string table =
      row("frames", fmt::format("{} of {}x{} px at {:.6g} Hz: {:.6g} s", e.frames, e.size.width_px,
                                e.size.height_px, e.rate_hz, e.duration_s));
  table += row("events", fmt::format("{} ({} ON, {} OFF), {:.0f} k/s", e.events_on + e.events_off,
                                     e.events_on, e.events_off, e.event_rate_hz / 1000));
  const auto all = static_cast<double>(e.events_on + e.events_off + e.events_lost);
  const double lost_percent = all > 0 ? 100 * static_cast<double>(e.events_lost) / all : 0;
  table += row("lost", fmt::format("{} in the readout ({:.1f} %)", e.events_lost, lost_percent));
  return table + row("delay", fmt::format("{} us at most, in the readout", e.max_delay.count()));
}

std::string warning(const Emulation& e) {
  std::string text;
  if (e.bad_values > 0)
    text = fmt::format(
        "{} pixels of the frames were negative (taken as 0), NaN, infinite or beyond 1e20 "
        "(taken as the pixel's last value)",
        e.bad_values);
  // A video's index may be off by a frame or two.
  constexpr int kOffBy = 2;
  if (e.frames + kOffBy < e.announced_frames)
    text += fmt::format("{}only {} of {} frames could be decoded", text.empty() ? "" : "; ",
                        e.frames, e.announced_frames);
  return text;
}

}  // namespace nightjar::scenarios
