#include "esi/esi_net.h"

#include <algorithm>
#include <utility>

#include "esi/channel_scaling.h"
#include "esi/esi_net_weights.h"

namespace nightjar::esi {
namespace {

float levels_per_unit(const EsiNetConfig& config) {
  core::check_config(config, "esi_net");
  return static_cast<float>(config.levels_per_sigma) /
         static_cast<float>(kFeatureOne << kEsiNetWeightBits);
}

}  // namespace

EsiNet::EsiNet(const EsiNetConfig& config, core::Resolution size)
    : Reconstructor(size),
      use_frames_(config.use_frames),
      shading_(halved(size.width_px), halved(size.height_px)),
      output_(levels_per_unit(config)),
      frame_blend_(size, config.levels_per_sigma) {
  const int width = halved(size.width_px), height = halved(size.height_px);
  features_ = ChannelImage(width, height, 4 * kPixelFeatures);
  first_ = second_ = ChannelImage(width, height, kConvolutionOut);
  reset();
}

void EsiNet::clear(core::Time start) {
  cells_.assign(static_cast<std::size_t>(size().pixels()), MemoryCell{{}, low_us(start)});
  frame_blend_.clear();
}

void EsiNet::limit_ages(std::uint32_t now_us, std::uint32_t most_us) {
  limit_times(cells_, now_us, most_us);
}

void EsiNet::integrate(std::span<const PackedEvent> events) {
  EventRun run(events);
  integrate_run(run);
}

void EsiNet::integrate_run(EventRun& run) { best_memory_variant().integrate(run, cells_.data()); }

void EsiNet::take_frame(core::ApsFrame&& frame) {
  if (use_frames_) frame_blend_.take(std::move(frame));
}

const ChannelImage& EsiNet::features(core::Time t) {
  quantise_features(low_us(t));
  return features_;
}

void EsiNet::quantise_features(std::uint32_t now_us) {
  for (int y = 0; y < 2 * features_.height(); ++y) {
    const int from_y = std::min(y, size().height_px - 1);
    const MemoryCell* from = cells_.data() + std::ptrdiff_t{from_y} * size().width_px;
    std::int16_t* to = features_.at(0, y / 2) + y % 2 * 2 * kPixelFeatures;
    best_memory_variant().features(from, size().width_px, now_us, to);
  }
}

void EsiNet::draw(core::Time t, core::Image<std::uint8_t>& gray) {
  quantise_features(low_us(t));
  const EdgeWeights& edges = edges_.mix(second_share(features_, esi_net_gate()));
  ChannelImage& third = first_;  // the first one's values are needed no longer then
  convolve(edges.layers[0], features_, first_);
  convolve(edges.layers[1], first_, second_);
  convolve(edges.layers[2], second_, third);
  output_.set_weights(edges.output, edges.output_bias);
  output_.write(third, features_, shading_.of(second_, third), gray);
  frame_blend_.blend(cells_, t, gray);
}

}  // namespace nightjar::esi
