#include "scenarios/process_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

namespace nightjar::scenarios {
namespace {

double milliseconds(core::Time t) { return 1e3 * core::seconds(t); }

std::string losses(const ProcessReport& report) {
  std::string text;
  const auto tell = [&](std::uint64_t count, const char* what) {
    if (count > 0) text += fmt::format(", {} {}", count, what);
  };
  tell(report.messages_lost, "messages lost");
  tell(report.steps_lost, "steps lost");
  tell(report.steps_dropped, "steps dropped");
  tell(report.steps_late, "steps late");
  tell(report.steps_repeated, "steps repeated");
  tell(report.refused, "messages refused");
  return text.empty() ? ", nothing lost" : text;
}

double elapsed_s(std::chrono::steady_clock::time_point since) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
}

}  // namespace

std::string to_line(const ProcessReport& report) {
  return fmt::format("{}: {} steps, {:.1f} /s, latency {:.2f} ms median, {:.2f} 99 %, {:.2f} max{}",
                     report.process, report.steps, report.rate_hz(),
                     milliseconds(report.latency.quantile(0.5)),
                     milliseconds(report.latency.quantile(0.99)),
                     milliseconds(report.latency.greatest()), losses(report));
}

std::string to_json(const ProcessReport& report) {
  return nlohmann::ordered_json({{"process", report.process},
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
                                 {"estimates_sha256", report.estimates_sha256}})
             .dump(2) +
         '\n';
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
