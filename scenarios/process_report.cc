#include "scenarios/process_report.h"

#include <fmt/format.h>

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <utility>

namespace nightjar::scenarios {
namespace {

double milliseconds(core::Time t) { return 1e3 * core::seconds(t); }

/// Those that are not 0, each after a comma.
std::string losses(std::initializer_list<std::pair<std::uint64_t, const char*>> counts) {
  std::string text;
  for (const auto& [count, what] : counts)
    if (count > 0) text += fmt::format(", {} {}", count, what);
  return text.empty() ? ", nothing lost" : text;
}

std::string losses(const ProcessReport& report) {
  return losses({{report.messages_lost, "messages lost"},
                 {report.steps_lost, "steps lost"},
                 {report.steps_dropped, "steps dropped"},
                 {report.steps_late, "steps late"},
                 {report.steps_repeated, "steps repeated"},
                 {report.refused, "messages refused"}});
}

std::uint64_t unusable(const camera::RecordingFaults& faults) {
  return faults.packets_unknown + faults.packets_damaged;
}

std::string to_line(const CameraReport& camera, double elapsed_s) {
  const camera::SourceCounts& counts = camera.counts;
  const double rate_mhz =
      elapsed_s > 0 ? 1e-6 * static_cast<double>(counts.events) / elapsed_s : 0.0;
  return fmt::format("; {}{}: {:.2f} Mev/s, {} frames, {} IMU samples{}", camera.name,
                     camera.connected ? "" : " (disconnected)", rate_mhz, counts.frames, counts.imu,
                     losses({{counts.packets_lost, "packets lost"},
                             {counts.disconnects, "disconnects"},
                             {counts.reconnects, "reconnects"},
                             {counts.faults.time_resets, "clock resets"},
                             {counts.faults.events_outside, "events off the sensor"},
                             {counts.faults.events_backwards, "events out of order"},
                             {unusable(counts.faults), "packets unusable"}}));
}

nlohmann::ordered_json json_of(const CameraReport& camera) {
  const camera::SourceCounts& counts = camera.counts;
  return {{"name", camera.name},
          {"connected", camera.connected},
          {"packets", counts.packets},
          {"events", counts.events},
          {"frames", counts.frames},
          {"imu_samples", counts.imu},
          {"triggers", counts.triggers},
          {"packets_lost", counts.packets_lost},
          {"disconnects", counts.disconnects},
          {"reconnects", counts.reconnects},
          {"clock_resets", counts.faults.time_resets},
          {"events_off_the_sensor", counts.faults.events_outside},
          {"events_out_of_order", counts.faults.events_backwards},
          {"packets_unusable", unusable(counts.faults)},
          {"first_fault", counts.faults.first}};
}

camera::SourceCounts operator-(camera::SourceCounts counts, const camera::SourceCounts& before) {
  counts.packets -= before.packets;
  counts.events -= before.events;
  counts.frames -= before.frames;
  counts.imu -= before.imu;
  counts.triggers -= before.triggers;
  counts.packets_lost -= before.packets_lost;
  counts.disconnects -= before.disconnects;
  counts.reconnects -= before.reconnects;
  counts.faults.packets_unknown -= before.faults.packets_unknown;
  counts.faults.packets_damaged -= before.faults.packets_damaged;
  counts.faults.events_outside -= before.faults.events_outside;
  counts.faults.events_backwards -= before.faults.events_backwards;
  counts.faults.time_resets -= before.faults.time_resets;
  return counts;
}

double elapsed_s(std::chrono::steady_clock::time_point since) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
}

}  // namespace

std::string to_line(const ProcessReport& report) {
  return fmt::format(
      "{}: {} steps, {:.1f} /s, latency {:.2f} ms median, {:.2f} 99 %, {:.2f} max{}{}",
      report.process, report.steps, report.rate_hz(), milliseconds(report.latency.quantile(0.5)),
      milliseconds(report.latency.quantile(0.99)), milliseconds(report.latency.greatest()),
      losses(report), report.camera ? to_line(*report.camera, report.elapsed_s) : "");
}

std::string to_json(const ProcessReport& report) {
  nlohmann::ordered_json json = {{"process", report.process},
                                 {"steps", report.steps},
                                 {"rate_hz", report.rate_hz()},
                                 {"latency_median_us", report.latency.quantile(0.5).count()},
                                 {"latency_99_percent_us", report.latency.quantile(0.99).count()},
                                 {"latency_max_us", report.latency.greatest().count()},
                                 {"messages_lost", report.messages_lost},
                                 {"steps_lost", report.steps_lost},
                                 {"steps_dropped", report.steps_dropped},
                                 {"steps_late", report.steps_late},
                                 {"steps_repeated", report.steps_repeated},
                                 {"messages_refused", report.refused},
                                 {"first_refusal", report.first_refusal},
                                 {"estimates_sha256", report.estimates_sha256}};
  if (report.camera) json["camera"] = json_of(*report.camera);
  return json.dump(2) + '\n';
}

ProcessMeter::ProcessMeter(std::string process) { total_.process = std::move(process); }

void ProcessMeter::count_step() {
  if (total_.steps++ == 0) began_ = interval_began_ = Clock::now();
}

void ProcessMeter::add_latency(core::Time latency) {
  total_.latency.add(latency);
  recent_.add(latency);
}

ProcessReport ProcessMeter::report() const {
  ProcessReport report = total_;
  if (report.steps > 0) report.elapsed_s = elapsed_s(began_);
  return report;
}

ProcessReport ProcessMeter::take_interval() {
  ProcessReport interval = total_;
  interval.steps -= before_.steps;
  interval.messages_lost -= before_.messages_lost;
  interval.steps_lost -= before_.steps_lost;
  interval.steps_dropped -= before_.steps_dropped;
  interval.steps_late -= before_.steps_late;
  interval.steps_repeated -= before_.steps_repeated;
  interval.refused -= before_.refused;
  if (before_.camera) interval.camera->counts = interval.camera->counts - before_.camera->counts;
  interval.latency = std::exchange(recent_, {});
  if (total_.steps > 0) interval.elapsed_s = elapsed_s(interval_began_);
  interval_began_ = Clock::now();
  before_ = total_;
  return interval;
}

core::Time steady_now() {
  return std::chrono::duration_cast<core::Time>(
      std::chrono::steady_clock::now().time_since_epoch());
}

}  // namespace nightjar::scenarios
