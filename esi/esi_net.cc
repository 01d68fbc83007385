#include "esi/esi_net.h"

#include <algorithm>
#include <utility>

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
      output_(esi_net_output(), esi_net_output_bias(), levels_per_unit(config)) {
  const int width = (size.width_px + 1) / 2, height = (size.height_px + 1) / 2;
  features_ = ChannelImage(width, height, 4 * kPixelFeatures);
  hidden_ = next_hidden_ = ChannelImage(width, height, kConvolutionOut);
  reset();
}

void EsiNet::clear(core::Time start) {
  cells_.assign(static_cast<std::size_t>(size().pixels()), MemoryCell{{}, low_us(start)});
}

void EsiNet::limit_ages(std::uint32_t now_us, std::uint32_t most_us) {
  limit_times(cells_, now_us, most_us);
}

void EsiNet::integrate(std::span<const PackedEvent> events) {
  EventRun run(events);
  integrate_run(run);
}

void EsiNet::integrate_run(EventRun& run) { best_memory_variant().integrate(run, cells_.data()); }

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
  const ChannelImage* in = &features_;
  for (const Convolution& layer : esi_net_layers()) {
    convolve(layer, *in, next_hidden_);
    std::swap(hidden_, next_hidden_);
    in = &hidden_;
  }
  output_.write(hidden_, features_, gray);
}

}  // namespace nightjar::esi
