#include "scenarios/summary.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace nightjar::scenarios {
namespace {

using Json = nlohmann::ordered_json;  // members in the order written here

Json json(const PhaseCount& count) {
  return {{"pictures", count.pictures}, {"detections", count.detections}};
}

Json json(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json json(const std::vector<core::MissionTransition>& transitions) {
  Json list = Json::array();
  for (const core::MissionTransition& step : transitions)
    list.push_back({{"time_s", core::seconds(step.t)},
                    {"from", core::to_string(step.from)},
                    {"to", core::to_string(step.to)},
                    {"cause", step.cause}});
  return list;
}

Json json(const std::vector<core::StageTime>& profile) {
  Json list = Json::array();
  for (const core::StageTime& time : profile)
    list.push_back({{"stage", time.stage},
                    {"thread", time.thread},
                    {"wall_s", std::chrono::duration<double>(time.wall).count()},
                    {"calls", time.calls}});
  return list;
}

std::string row(const char* name, const std::string& value) {
  return fmt::format("  {:<26}{}\n", name, value);
}

std::string row(const char* name, const PhaseCount& count) {
  return row(name, fmt::format("{} of {} pictures", count.detections, count.pictures));
}

std::string metres(const std::optional<double>& value_m) {
  return value_m ? fmt::format("{:.3f} m", *value_m) : "-";
}

std::string yes_no(bool value) { return value ? "yes" : "no"; }

}  // namespace

std::string to_json(const Summary& s) {
  const Json summary = {
      {"scenario", s.scenario},
      {"seed", s.seed},
      {"sim_time_s", s.sim_time_s},
      {"wall_time_s", s.wall_time_s},
      {"real_time_factor", s.real_time_factor},
      {"pictures", s.pictures},
      {"detections", s.detections},
      {"detection_rate", s.detection_rate},
      {"false_detections", s.false_detections},
      {"phases",
       {{"straight", json(s.straight)},
        {"turning", json(s.turning)},
        {"landing", json(s.landing)}}},
      {"events", s.events},
      {"events_lost", s.events_lost},
      {"event_rate_hz", s.event_rate_hz},
      {"max_readout_delay_us", s.max_readout_delay_us},
      {"bad_radiance", s.bad_radiance},
      {"renders", s.renders},
      {"renders_late", s.renders_late},
      {"landed", s.landed},
      {"crashed", s.crashed},
      {"ugv_collided", s.ugv_collided},
      {"touchdown_error_m", json(s.touchdown_error_m)},
      {"relative_position_rmse_m", json(s.relative_position_rmse_m)},
      {"transitions", json(s.transitions)},
      {"estimates_sha256", s.estimates_sha256},
      {"passed", s.passed},
      {"failed_criteria", s.failed_criteria},
      {"profile", json(s.profile)},
  };
  return summary.dump(2) + '\n';
}

std::string to_table(const Summary& s) {
  std::string table = fmt::format("{}, seed {}\n", s.scenario, s.seed);
  table += row("simulated", fmt::format("{:.1f} s in {:.1f} s ({:.2f} x real time)", s.sim_time_s,
                                        s.wall_time_s, s.real_time_factor));
  table +=
      row("events", fmt::format("{} ({:.0f} k/s), {} lost, read out after {} us at most", s.events,
                                s.event_rate_hz / 1000, s.events_lost, s.max_readout_delay_us));
  table += row("tag found", fmt::format("{} of {} pictures ({:.1f} %), {} false", s.detections,
                                        s.pictures, 100 * s.detection_rate, s.false_detections));
  table += row("  straight", s.straight);
  table += row("  turning", s.turning);
  table += row("  landing", s.landing);
  table += row("relative position, rms", metres(s.relative_position_rmse_m));
  table += row("landed", yes_no(s.landed));
  table += row("touchdown error", metres(s.touchdown_error_m));
  if (s.crashed) table += row("crashed", yes_no(true));
  if (s.ugv_collided) table += row("UGV hit an obstacle", yes_no(true));
  for (const core::MissionTransition& step : s.transitions)
    table += row("mission",
                 fmt::format("{:7.2f} s  {} -> {}: {}", core::seconds(step.t),
                             core::to_string(step.from), core::to_string(step.to), step.cause));
  table += row("passed", yes_no(s.passed));
  for (const std::string& line : s.failed_criteria) table += row("", line);
  return table;
}

std::string profile_table(const Summary& s) {
  std::string table = fmt::format("{:<10}{:<20}{:>9}{:>10}{:>10}{:>12}\n", "thread", "stage",
                                  "calls", "total s", "ms/call", "% of wall");
  for (const core::StageTime& time : s.profile) {
    const double wall_s = std::chrono::duration<double>(time.wall).count();
    table += fmt::format("{:<10}{:<20}{:>9}{:>10.2f}{:>10.3f}{:>12.1f}\n", time.thread, time.stage,
                         time.calls, wall_s,
                         time.calls > 0 ? 1e3 * wall_s / static_cast<double>(time.calls) : 0.0,
                         s.wall_time_s > 0 ? 100 * wall_s / s.wall_time_s : 0.0);
  }
  return table;
}

}  // namespace nightjar::scenarios
