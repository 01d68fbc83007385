#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "camera/event_source.h"
#include "scenarios/latency_histogram.h"

namespace nightjar::scenarios {

/// What a source that reads a camera says of it.
struct CameraReport {
  std::string name;
  bool connected = true;
  camera::SourceCounts counts;
};

/// What a process says of itself, over the last second or over all its time.
struct ProcessReport {
  std::string process;
  std::uint64_t steps = 0;  ///< Event packets dealt with.
  double elapsed_s = 0;     ///< From the first of them on.
  /// From the source's having the packet to this process's being done with it (a source:
  /// to the answer, where it hears any).
  LatencyHistogram latency;
  std::uint64_t messages_lost = 0;   ///< On the way to this process.
  std::uint64_t steps_lost = 0;      ///< Likewise, whole steps.
  std::uint64_t steps_dropped = 0;   ///< By this process, to keep up.
  std::uint64_t steps_late = 0;      ///< Sent later than real time asked.
  std::uint64_t steps_repeated = 0;  ///< Sent again in lock-step.
  std::uint64_t refused = 0;         ///< Messages that could not be used.
  std::string first_refusal;         ///< Why the first of them could not, else empty.
  std::string estimates_sha256;      ///< Of the run so far (EstimatesHash), else empty.
  std::optional<CameraReport> camera;

  double rate_hz() const { return elapsed_s > 0 ? static_cast<double>(steps) / elapsed_s : 0; }
};

/// In one line, without its end.
std::string to_line(const ProcessReport& report);

/// All of it, latencies in microseconds.
std::string to_json(const ProcessReport& report);

/// Keeps both reports of a process.
class ProcessMeter {
 public:
  explicit ProcessMeter(std::string process);

  /// A step is dealt with, or sent.
  void count_step();

  /// Something came of a step, so long after its origin.
  void add_latency(core::Time latency);

  /// To count losses and the like in.
  ProcessReport& total() { return total_; }

  /// The whole time's report, up to now.
  ProcessReport report() const;

  /// What has come since the call before.
  ProcessReport take_interval();

 private:
  using Clock = std::chrono::steady_clock;

  ProcessReport total_;
  ProcessReport before_;     // totals at the last take_interval()
  LatencyHistogram recent_;  // since then
  Clock::time_point began_, interval_began_;
};

/// The steady clock's time as messages carry it (msg::StepMark::origin).
core::Time steady_now();

}  // namespace nightjar::scenarios
