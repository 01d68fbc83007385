#include "scenarios/reconstruction.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <vector>

namespace nightjar::scenarios {
namespace {

std::string row(const char* name, const std::string& value) {
  return fmt::format("  {:<12}{}\n", name, value);
}

double tag_rate(const Reconstruction& r) {
  return r.pictures > 0 ? static_cast<double>(r.pictures_with_tag) / static_cast<double>(r.pictures)
                        : 0;
}

double real_time_factor(const Reconstruction& r) {
  return r.wall_time_s > 0 ? r.duration_s() / r.wall_time_s : 0;
}

}  // namespace

std::string to_table(const Reconstruction& r) {
  std::string table =
      row("pictures", fmt::format("{} of {}x{} px, {:.6g}/s, by {}", r.pictures, r.size.width_px,
                                  r.size.height_px, r.rate_hz, r.method));
  table += row("recording", fmt::format("{} events and {} frames used, {:.6f} s from {} us on",
                                        r.events, r.frames, r.duration_s(), r.begin.count()));
  if (r.searched)
    table += row("tags", fmt::format("{} in {} of {} pictures ({:.1f} %)", r.tags,
                                     r.pictures_with_tag, r.pictures, 100 * tag_rate(r)));
  return table + row("took", fmt::format("{:.2f} s ({:.2f} x real time)", r.wall_time_s,
                                         real_time_factor(r)));
}

std::string to_json(const Reconstruction& r) {
  nlohmann::ordered_json json = {
      {"method", r.method},
      {"width_px", r.size.width_px},
      {"height_px", r.size.height_px},
      {"fps", r.rate_hz},
      {"begin_us", r.begin.count()},
      {"end_us", r.end.count()},
      {"duration_s", r.duration_s()},
      {"events", r.events},
      {"frames", r.frames},
      {"frames_refused", r.frames_refused},
      {"pictures", r.pictures},
      {"pictures_left_out", r.pictures_left_out},
  };
  if (r.searched) {
    json["tags"] = r.tags;
    json["pictures_with_tag"] = r.pictures_with_tag;
    json["detection_rate"] = tag_rate(r);
  }
  json["wall_time_s"] = r.wall_time_s;
  json["real_time_factor"] = real_time_factor(r);
  json["bytes_lost"] = r.faults.bytes_lost;
  json["packets_unknown"] = r.faults.packets_unknown;
  json["packets_damaged"] = r.faults.packets_damaged;
  json["events_outside"] = r.faults.events_outside;
  json["events_backwards"] = r.faults.events_backwards;
  json["time_resets"] = r.faults.time_resets;
  return json.dump(2) + '\n';
}

std::string warning(const Reconstruction& r) {
  std::vector<std::string> parts;
  if (r.faults.any())
    parts.push_back(fmt::format(
        "not all of the recording could be used: {} bytes lost, {} packets unknown, {} damaged, {} "
        "events "
        "outside the sensor, {} running backwards, {} resets of the clock; first: {}",
        r.faults.bytes_lost, r.faults.packets_unknown, r.faults.packets_damaged,
        r.faults.events_outside, r.faults.events_backwards, r.faults.time_resets, r.faults.first));
  if (r.frames_refused > 0)
    parts.push_back(
        fmt::format("{} frames left out, the first for: {}", r.frames_refused, r.first_refusal));
  if (r.pictures_left_out > 0)
    parts.push_back(fmt::format("{} pictures left out where no events came for over a minute",
                                r.pictures_left_out));
  if (r.pictures == 0)
    parts.push_back(
        fmt::format("no picture was due: the recording takes {:.6g} s, pictures come "
                    "every {:.6g} s",
                    r.duration_s(), 1 / r.rate_hz));
  return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace nightjar::scenarios
