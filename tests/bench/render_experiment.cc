// How often must the scene be drawn? One flight over the moving UGV is drawn at 5 kHz
// and by each choice below; the noise-free pixels' events are compared, pixel by pixel.
// Prints a Markdown table (docs/rendering.md).

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "core/random.h"
#include "sim/emulator.h"
#include "sim/simulation.h"
#include "sim/view_motion.h"

namespace {

using namespace nightjar;
using namespace std::chrono_literals;

constexpr std::uint64_t kSeed = 31;
constexpr double kWhite_lux = 5.0;
constexpr core::Time kReference = 200us;
constexpr core::Time kDuration = 2s;
const std::filesystem::path kArena =
    std::filesystem::path(NIGHTJAR_SOURCE_DIR) / "models" / "arena.xml";

/// Both vehicles at one moment, and the image motion there.
struct Moment {
  Eigen::Isometry3d T_world_uav, T_world_tag;
  double motion_px_s;
};

struct Flight {
  std::vector<Moment> moments;  ///< One a physics step.
  core::Time step;
};

/// Holds the UAV near a point over the tag, as the controller does, swaying and sinking.
core::AttitudeSetpoint follow(const core::Truth& truth, double height_m) {
  const double t_s = core::seconds(truth.t);
  const Eigen::Vector3d wanted =
      truth.T_world_tag.translation() +
      Eigen::Vector3d(0.1 * std::sin(3 * t_s), 0.1 * std::cos(2 * t_s), height_m - 0.2 * t_s);
  const Eigen::Vector3d a = 4 * (wanted - truth.uav.p_world_body_m) +
                            3 * (truth.v_world_tag_m_s - truth.uav.v_world_body_m_s) +
                            Eigen::Vector3d(0.25 * std::sin(5 * t_s), 0, 9.81);
  core::AttitudeSetpoint setpoint;
  setpoint.q_world_body = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), a);
  setpoint.thrust_m_s2 = a.norm();
  return setpoint;
}

Flight fly(double height_m) {
  sim::WorldConfig config;
  config.start_from_tag_m = {0.0, 0.1, height_m};
  config.ugv.course = {{3.0, -2.2, 0.4, sim::CoursePhase::straight},
                       {9.0, -1.2, 0.4, sim::CoursePhase::straight}};
  sim::World world(config, {}, kArena, kSeed);
  Flight flight{{}, world.time_step()};
  for (; world.now() <= kDuration; world.step()) {
    const core::Truth truth = world.truth();
    flight.moments.push_back(
        {truth.uav.T_world_body(), truth.T_world_tag, world.image_motion_px_s()});
    if (world.now() % 10ms == 0us) world.command(follow(truth, height_m));
  }
  return flight;
}

Eigen::Isometry3d between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double share) {
  const Eigen::Quaterniond qa(a.linear()), qb(b.linear());
  Eigen::Isometry3d T(qa.slerp(share, qb));
  T.pretranslate((1 - share) * a.translation() + share * b.translation());
  return T;
}

/// The scene of a flight at any time: poses between two steps are interpolated.
class Replay {
 public:
  Replay(const Flight& flight, int supersampling)
      : flight_(flight),
        camera_(scene_.id(mjOBJ_CAMERA, "dvs")),
        renderer_(scene_, {346, 260}, supersampling) {
    scene_.model()->cam_fovy[camera_] = sim::CameraConfig{}.fovy_deg;
    T_tag_ugv_ = scene_.T_world_site(scene_.id(mjOBJ_SITE, "tag")).inverse() *
                 scene_.T_world_body(scene_.id(mjOBJ_BODY, "ugv"));
  }

  void draw(core::Time t, core::Image<float>& luminance_lux) {
    const auto last = static_cast<std::int64_t>(flight_.moments.size()) - 2;
    const auto k = std::min(t / flight_.step, last);
    const double share = core::seconds(t - k * flight_.step) / core::seconds(flight_.step);
    const Moment &a = flight_.moments[k], &b = flight_.moments[k + 1];
    scene_.place("uav", between(a.T_world_uav, b.T_world_uav, share));
    scene_.place("ugv", between(a.T_world_tag, b.T_world_tag, share) * T_tag_ugv_);
    mj_kinematics(scene_.model(), scene_.data());
    mj_comPos(scene_.model(), scene_.data());
    mj_camlight(scene_.model(), scene_.data());
    renderer_.draw(scene_, camera_, kWhite_lux, luminance_lux);
  }

 private:
  const Flight& flight_;
  sim::Scene scene_{kArena};
  int camera_;
  sim::Renderer renderer_;
  Eigen::Isometry3d T_tag_ugv_;
};

/// The `dim` pixel without its noise; its low pass and its mismatch stay.
sim::PixelConfig quiet_dim() {
  sim::PixelConfig pixel = sim::preset_pixel(sim::SensorPreset::dim, kWhite_lux);
  pixel.leak_rate_hz = pixel.shot_noise_rate_hz = pixel.hot_pixel_fraction = 0;
  return pixel;
}

struct Stream {
  std::vector<core::Event> events;
  std::uint64_t renders = 0;
  double draw_s = 0, emulate_s = 0;
};

/// Adds what rounding to 16 bits has cost, once more.
void round_again(core::Image<float>& luminance_lux, core::Random& random) {
  constexpr double kCode_lux = sim::Renderer::kBrightest * kWhite_lux / 65535;
  for (float& value : luminance_lux.pixels())
    value += static_cast<float>(kCode_lux * (core::uniform01(random) - 0.5));
}

/// `next(t)` is the interval after the render at t.
Stream emulate(const Flight& flight, int supersampling,
               const std::function<core::Time(core::Time)>& next, bool rounded_again = false) {
  Replay replay(flight, supersampling);
  sim::EventEmulator emulator(quiet_dim(), {346, 260}, kWhite_lux, kSeed);
  Stream stream;
  core::Image<float> luminance_lux;
  core::Random random = core::random_stream(kSeed, "rounding");
  const auto clock = [] { return std::chrono::steady_clock::now(); };
  for (core::Time t{}; t < kDuration; t = std::min(t + next(t), kDuration)) {
    const auto begin = clock();
    replay.draw(t, luminance_lux);
    const auto drawn = clock();
    if (rounded_again) round_again(luminance_lux, random);
    emulator.step(t, luminance_lux, stream.events);
    stream.draw_s += std::chrono::duration<double>(drawn - begin).count();
    stream.emulate_s += std::chrono::duration<double>(clock() - drawn).count();
    ++stream.renders;
  }
  return stream;
}

using Times = std::vector<std::vector<core::Time>>;

/// Event times of each pixel and sign.
Times by_pixel(const std::vector<core::Event>& events) {
  Times times(2 * 346 * 260);
  for (const core::Event& e : events) times[2 * (e.y * 346 + e.x) + e.on].push_back(e.t);
  return times;
}

struct Agreement {
  double missing = 0, extra = 0;                 ///< Of the reference's events.
  double median_us = 0, p90_us = 0, p99_us = 0;  ///< Of the time error of the others.
};

/// Pairs each pixel's events of one sign in order, within 10 ms.
Agreement compare(const Stream& reference, const Stream& stream) {
  const Times wanted = by_pixel(reference.events), got = by_pixel(stream.events);
  std::vector<double> errors_us;
  for (std::size_t p = 0; p < wanted.size(); ++p) {
    std::size_t j = 0;
    for (const core::Time t : wanted[p]) {
      while (j < got[p].size() && got[p][j] < t - 10ms) ++j;
      if (j == got[p].size() || got[p][j] > t + 10ms) continue;
      errors_us.push_back(std::abs(static_cast<double>((got[p][j++] - t).count())));
    }
  }
  std::sort(errors_us.begin(), errors_us.end());
  const auto quantile = [&](double q) {
    return errors_us[static_cast<std::size_t>(q * static_cast<double>(errors_us.size() - 1))];
  };
  const auto all = static_cast<double>(reference.events.size());
  const auto paired = static_cast<double>(errors_us.size());
  return {1 - paired / all, (static_cast<double>(stream.events.size()) - paired) / all,
          quantile(0.5), quantile(0.9), quantile(0.99)};
}

void print_row(const std::string& name, const Stream& reference, const Stream& stream) {
  const Agreement a = compare(reference, stream);
  const double s = core::seconds(kDuration);
  fmt::print(
      "| {} | {:.0f} | {:.4f} | {:.2f} % | {:.2f} % | {:.0f} | {:.0f} | {:.0f} | {:.2f} | {:.2f} "
      "|\n",
      name, static_cast<double>(stream.renders) / s,
      static_cast<double>(stream.events.size()) / static_cast<double>(reference.events.size()),
      100 * a.missing, 100 * a.extra, a.median_us, a.p90_us, a.p99_us, stream.draw_s / s,
      stream.emulate_s / s);
  std::fflush(stdout);
}

void compare_choices(double height_m) {
  const Flight flight = fly(height_m);
  const auto every = [](core::Time dt) { return [dt](core::Time) { return dt; }; };
  const auto adaptive = [&flight](double max_motion_px) {
    sim::RendererConfig config;
    config.max_motion_px = max_motion_px;
    return [&flight, config](core::Time t) {
      return sim::render_interval(config, flight.moments[t / flight.step].motion_px_s, flight.step);
    };
  };
  const Stream reference = emulate(flight, 1, every(kReference));
  fmt::print(
      "\nFrom {} m above the board, sinking at 0.2 m/s: {} events in {} s.\n\n"
      "| drawn | renders/s | events, ratio | missing | extra | time error, median us | 90 % | "
      "99 % | draw s/s | emulate s/s |\n|---|---|---|---|---|---|---|---|---|---|\n",
      height_m, reference.events.size(), core::seconds(kDuration));
  print_row("every 0.2 ms (reference)", reference, reference);
  for (const double px : {0.25, 0.5, 1.0, 2.0})
    print_row(fmt::format("at most {} px apart", px), reference, emulate(flight, 1, adaptive(px)));
  for (const core::Time dt : {1000us, 2000us, 5000us, 10000us})
    print_row(fmt::format("every {} ms", dt.count() / 1000), reference,
              emulate(flight, 1, every(dt)));
  print_row("every 0.2 ms, rounded to 16 bits twice", reference,
            emulate(flight, 1, every(kReference), true));
  const Stream fine = emulate(flight, 2, every(kReference));
  print_row("every 0.2 ms, 2x2 samples", reference, fine);
  print_row("at most 0.5 px apart, 2x2 samples, against the row above", fine,
            emulate(flight, 2, adaptive(0.5)));
}

}  // namespace

int main() {
  for (const double height_m : {1.4, 0.8}) compare_choices(height_m);
}
