// Training samples for esi_net: flat random scenes seen by a carried, random sensor.
//
//   make_samples FIRST_SEED LAST_SEED DIR [bright]
//
// With `bright` only of the seeds, one in eight, whose scene is so and in quick motion.
// For each seed DIR/SEED.features and DIR/SEED.truth: patches one after the other, as
// tools/training/samples.py reads them. Features are what EsiNet's network sees, int16,
// [96][96][32]; the truth is luminance over the patch's mean, float, [192][192].

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "core/camera_model.h"
#include "core/part_file.h"
#include "esi/esi_net.h"
#include "esi/esi_net_weights.h"
#include "sim/carried_path.h"
#include "sim/simulated_camera.h"
#include "tools/training/texture.h"

namespace nightjar::training {
namespace {

constexpr core::Resolution kSensor{346, 260};
constexpr int kPatch_px = 192;  // the shading sees more than 100 px far
constexpr int kPatchesAPicture = 2;
constexpr int kTexture_px = 1600;
constexpr double kTextureScale_px_m = 247;  // a pixel of the texture is one of the sensor at 1.2 m
constexpr core::Time kPacket{10'000};

/// Lights and pixels: the simulator's own by illuminance, or any within wide bounds.
struct Sensor {
  sim::SensorConfig config;
  double illuminance_lux;

  bool is_bright() const {
    return config.preset != sim::SensorPreset::custom && illuminance_lux > 150;
  }
};

Sensor draw_sensor(core::Random& random) {
  Sensor sensor{{}, log_between(1.5, 20, random)};
  if (core::uniform01(random) < 0.45) {
    if (random() % 3 != 0) sensor.illuminance_lux = log_between(20, 2000, random);
    return sensor;
  }
  sensor.config.preset = sim::SensorPreset::custom;
  sim::PixelConfig& pixel = sensor.config.pixel;
  const double threshold_log = log_between(0.12, 0.4, random);
  const double unlike = std::exp(std::clamp(0.25 * core::normal(random), -0.55, 0.55));
  pixel.threshold_on_log = threshold_log * unlike;
  pixel.threshold_off_log = threshold_log / unlike;
  pixel.threshold_on_sigma_log = pixel.threshold_off_sigma_log =
      between(0.1, 0.35, random) * threshold_log;
  pixel.cutoff_hz = log_between(20, 1000, random);
  pixel.leak_rate_hz = log_between(0.02, 0.4, random);
  pixel.shot_noise_rate_hz = log_between(0.02, 15, random);
  pixel.hot_pixel_fraction = log_between(3e-5, 1e-3, random);
  pixel.refractory_us = random() % 2 != 0 ? 0 : log_between(50, 2000, random);
  return sensor;
}

/// The flat scene as the carried camera sees it.
class FlatScene {
 public:
  FlatScene(core::Image<float> texture, double zoom, sim::CarryMotion motion, std::uint64_t seed)
      : texture_(std::move(texture)),
        path_(motion, seed),
        model_(core::CameraModel::from_fovy(kSensor, 47.3 * std::numbers::pi / 180)),
        scale_px_m_(kTextureScale_px_m * zoom) {}

  void draw(core::Time t, double white_lux, core::Image<float>& luminance_lux) const {
    cv::Mat picture(kSensor.height_px, kSensor.width_px, CV_32F, luminance_lux.pixels().data());
    const cv::Mat texture(kTexture_px, kTexture_px, CV_32F,
                          const_cast<float*>(texture_.pixels().data()));
    cv::warpPerspective(texture, picture, texture_from_pixel(t), picture.size(),
                        cv::INTER_LINEAR | cv::WARP_INVERSE_MAP, cv::BORDER_REFLECT);
    picture *= white_lux;
  }

  /// How far the picture's corners move.
  double motion_px(core::Time from, core::Time to) const {
    const cv::Matx33d H = texture_from_pixel(to).inv() * texture_from_pixel(from);
    double most_px = 0;
    for (const double x : {0.0, kSensor.width_px - 1.0})
      for (const double y : {0.0, kSensor.height_px - 1.0}) {
        const cv::Vec3d p = H * cv::Vec3d(x, y, 1);
        most_px = std::max(most_px, std::hypot(p[0] / p[2] - x, p[1] / p[2] - y));
      }
    return most_px;
  }

 private:
  cv::Matx33d texture_from_pixel(core::Time t) const {
    const Eigen::Isometry3d T_camera_target = path_.T_target_camera(t).inverse();
    Eigen::Matrix3d plane;  // of z = 0
    plane << T_camera_target.linear().leftCols<2>(), T_camera_target.translation();
    Eigen::Matrix3d K, target_from_texture;
    K << model_.fx_px, 0, model_.cx_px, 0, model_.fy_px, model_.cy_px, 0, 0, 1;
    const double middle_m = 0.5 * kTexture_px / scale_px_m_;
    target_from_texture << 1 / scale_px_m_, 0, -middle_m, 0, -1 / scale_px_m_, middle_m, 0, 0, 1;
    const Eigen::Matrix3d H = (K * plane * target_from_texture).inverse();
    return {H(0, 0), H(0, 1), H(0, 2), H(1, 0), H(1, 1), H(1, 2), H(2, 0), H(2, 1), H(2, 2)};
  }

  core::Image<float> texture_;
  sim::CarriedPath path_;
  core::CameraModel model_;
  double scale_px_m_;
};

core::Time next_render(const FlatScene& scene, core::Time now, core::Time packet_end) {
  core::Time interval = std::min(core::Time(5000), packet_end - now);
  while (interval > core::Time(400) && scene.motion_px(now, now + interval) > 0.5)
    interval = std::max(core::Time(400), interval * 3 / 4);
  return now + interval;
}

/// Appends patches at random places of one picture; none where there is hardly anything to see.
void write_patches(const esi::ChannelImage& features, const core::Image<float>& luminance_lux,
                   core::Random& random, std::ostream& features_out, std::ostream& truth_out) {
  const cv::Mat luminance(kSensor.height_px, kSensor.width_px, CV_32F,
                          const_cast<float*>(luminance_lux.pixels().data()));
  for (int n = 0; n < kPatchesAPicture; ++n) {
    const int x = 2 * whole_between(0, (kSensor.width_px - kPatch_px) / 2, random);
    const int y = 2 * whole_between(0, (kSensor.height_px - kPatch_px) / 2, random);
    cv::Mat patch = luminance({x, y, kPatch_px, kPatch_px}).clone();
    cv::Scalar mean, deviation;
    cv::meanStdDev(patch, mean, deviation);
    if (deviation[0] < 0.08 * mean[0]) continue;
    patch /= mean[0];
    truth_out.write(reinterpret_cast<const char*>(patch.data), kPatch_px * kPatch_px * 4);
    for (int row = 0; row < kPatch_px / 2; ++row)
      features_out.write(reinterpret_cast<const char*>(features.at(x / 2, y / 2 + row)),
                         kPatch_px / 2 * features.channels() * 2);
  }
}

/// Returns whether the seed was wanted.
bool make_samples(std::uint64_t seed, const std::string& folder, bool bright_only) {
  core::Random random = core::random_stream(seed, "training");
  const Sensor sensor = draw_sensor(random);
  constexpr std::array kMotions{sim::CarryMotion::hover, sim::CarryMotion::slow,
                                sim::CarryMotion::fast,  sim::CarryMotion::fast,
                                sim::CarryMotion::shake, sim::CarryMotion::shake};
  const sim::CarryMotion motion = kMotions[random() % kMotions.size()];
  const bool is_quick = motion == sim::CarryMotion::fast || motion == sim::CarryMotion::shake;
  if (bright_only && !(is_quick && sensor.is_bright())) return false;
  const FlatScene scene(draw_texture(kTexture_px, random), log_between(0.6, 1.6, random), motion,
                        seed);
  const core::Time end =
      core::from_seconds(between(1, motion == sim::CarryMotion::hover ? 5 : 2.5, random));
  // Some first pictures come early: recordings can be short.
  core::Time next_sample = core::from_seconds(log_between(0.012, 0.5, random));

  sim::SimulatedCamera camera(sensor.config, kSensor, sensor.illuminance_lux, seed);
  esi::EsiNet net({}, kSensor);
  core::PartFile features(folder + "/" + std::to_string(seed) + ".features");
  core::PartFile truth(folder + "/" + std::to_string(seed) + ".truth");
  core::Image<float> luminance_lux(kSensor);
  const auto render = [&](core::Time t) {
    scene.draw(t, sensor.illuminance_lux, luminance_lux);
    camera.expose(t, luminance_lux);
    return t;
  };
  for (core::Time now = render(core::Time(0)); now < end;) {
    for (const core::Time packet_end = now + kPacket; now < packet_end;)
      now = render(next_render(scene, now, packet_end));
    net.process(camera.take(now).packet.events);
    if (now < next_sample) continue;
    write_patches(net.features(now), luminance_lux, random, features.stream(), truth.stream());
    const double soon_s = between(0.5, 1.5, random) * core::seconds(now);
    next_sample = now + core::from_seconds(std::min(soon_s, between(0.1, 0.4, random)));
  }
  features.finish();
  truth.finish();
  return true;
}

}  // namespace
}  // namespace nightjar::training

int main(int argc, char** argv) {
  const bool bright_only = argc == 5 && std::string(argv[4]) == "bright";
  if (argc != 4 && !bright_only) {
    std::cerr << "usage: make_samples FIRST_SEED LAST_SEED DIR [bright]\n";
    return 2;
  }
  try {
    for (int seed = std::stoi(argv[1]); seed <= std::stoi(argv[2]); ++seed)
      if (nightjar::training::make_samples(static_cast<std::uint64_t>(seed), argv[3], bright_only))
        std::cerr << "seed " << seed << " done\n";
  } catch (const std::exception& error) {
    std::cerr << "make_samples: " << error.what() << '\n';
    return 2;
  }
}
