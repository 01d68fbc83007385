#include "scenarios/event_workloads.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "core/random.h"

namespace nightjar::scenarios {
namespace {

constexpr core::Resolution kSensor{346, 260};
constexpr core::Time kFramePeriod(40'000);
constexpr core::Time kExposure(10'000);
/// Events beyond it would begin the times anew.
constexpr core::Time kMostTime(std::int64_t{4'000'000'000});

struct Kind {
  EventPattern pattern;
  const char* name;
  double rate_mhz;
};
constexpr Kind kKinds[kWorkloads] = {{EventPattern::uniform, "uniform", 1},
                                     {EventPattern::uniform, "uniform", 5},
                                     {EventPattern::uniform, "uniform", 12},
                                     {EventPattern::moving_edges, "moving edges", 1},
                                     {EventPattern::moving_edges, "moving edges", 5},
                                     {EventPattern::moving_edges, "moving edges", 12}};

/// Where the pattern has an event at `t_s`.
class Place {
 public:
  Place(EventPattern pattern, double rate_hz)
      : pattern_(pattern), speed_px_s_(rate_hz / (kEdges * kSensor.height_px * kEventsPerPixel)) {}

  std::uint32_t pixel_on(double t_s, core::Random& random) const {
    if (pattern_ == EventPattern::uniform)
      return static_cast<std::uint32_t>(random() %
                                        static_cast<std::uint64_t>(2 * kSensor.pixels()));
    const std::uint64_t edge = random() % kEdges;
    const std::uint64_t y = random() % static_cast<std::uint64_t>(kSensor.height_px);
    const double begin_px = static_cast<double>(edge) * kSensor.width_px / kEdges;
    const double x_px = std::fmod(begin_px + kSlant * static_cast<double>(y) + speed_px_s_ * t_s +
                                      kWidth_px * core::uniform01(random),
                                  kSensor.width_px);
    const std::uint64_t pixel = y * kSensor.width_px + static_cast<std::uint64_t>(x_px);
    return static_cast<std::uint32_t>(2 * pixel + edge % 2);
  }

 private:
  static constexpr int kEdges = 8;
  static constexpr double kEventsPerPixel = 5;  ///< As one edge passes.
  static constexpr double kSlant = 0.2;
  static constexpr double kWidth_px = 2;

  EventPattern pattern_;
  double speed_px_s_;
};

/// Stripes and some noise: what is all noise, a method may leave out.
std::vector<core::ApsFrame> make_frames(core::Time end, core::Random& random) {
  constexpr int kStripe_px = 43;
  core::ApsFrame frame{{}, {}, 10, core::Image<std::uint16_t>(kSensor)};
  for (int y = 0; y < kSensor.height_px; ++y)
    for (int x = 0; x < kSensor.width_px; ++x)
      frame.gray(x, y) =
          static_cast<std::uint16_t>((x / kStripe_px % 2 == 0 ? 200 : 700) + random() % 64);
  std::vector<core::ApsFrame> frames;
  for (core::Time t = kFramePeriod; t <= end; t += kFramePeriod) {
    frame.exposure_begin = t - kExposure;
    frame.exposure_end = t;
    frames.push_back(frame);
  }
  return frames;
}

}  // namespace

void EventWorkload::cut_packets() {
  packet_ends.clear();
  std::uint32_t end_us = static_cast<std::uint32_t>(kPacket.count());
  for (std::size_t i = 0; i < events.size(); ++i)
    for (; events[i].t_us > end_us; end_us += static_cast<std::uint32_t>(kPacket.count()))
      packet_ends.push_back(i);
  packet_ends.push_back(events.size());
}

EventWorkload make_workload(EventPattern pattern, double rate_hz, std::size_t count,
                            std::uint64_t seed) {
  core::Random random = core::random_stream(seed, "workload");
  const Place place(pattern, rate_hz);
  EventWorkload workload{{}, kSensor, {}, {}, {}};
  workload.events.resize(count);
  double t_us = 0;
  for (esi::PackedEvent& event : workload.events) {
    t_us += 2e6 / rate_hz * core::uniform01(random);
    event = {static_cast<std::uint32_t>(t_us), place.pixel_on(1e-6 * t_us, random)};
  }
  workload.frames = make_frames(core::Time(static_cast<std::int64_t>(t_us)), random);
  workload.cut_packets();
  return workload;
}

EventWorkload make_workload(std::size_t index, std::size_t count) {
  const Kind& kind = kKinds[index];
  constexpr std::uint64_t kSeed = 1;
  EventWorkload workload = make_workload(kind.pattern, 1e6 * kind.rate_mhz, count, kSeed);
  workload.name = workload_name(index);
  return workload;
}

std::string workload_name(std::size_t index) {
  return fmt::format("{} {} Mev/s", kKinds[index].name, kKinds[index].rate_mhz);
}

EventWorkload read_workload(camera::RecordingReader& recording, std::string name,
                            std::size_t most) {
  EventWorkload workload{std::move(name), recording.size(), {}, {}, {}};
  camera::RecordingPart part;
  std::optional<core::Time> start;
  const auto since_start = [&](core::Time t) { return t - *start; };
  while (workload.events.size() < most && recording.next(part)) {
    if (!start && !part.events.empty()) start = part.events.front().t;
    for (const core::Event& e : part.events) {
      if (workload.events.size() == most || since_start(e.t) > kMostTime) break;
      core::Event shifted = e;
      shifted.t = since_start(e.t);
      workload.events.push_back(esi::pack(shifted, workload.size.width_px));
    }
    for (core::ApsFrame& frame : part.frames) {
      if (!start || frame.exposure_begin < *start) continue;
      frame.exposure_begin = since_start(frame.exposure_begin);
      frame.exposure_end = since_start(frame.exposure_end);
      workload.frames.push_back(std::move(frame));
    }
  }
  if (workload.events.empty()) throw std::invalid_argument(workload.name + ": holds no events");
  workload.cut_packets();
  return workload;
}

}  // namespace nightjar::scenarios
