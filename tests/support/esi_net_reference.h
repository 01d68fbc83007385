#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/event.h"
#include "core/image.h"
#include "esi/esi_net_weights.h"

namespace nightjar::test {

/// EsiNet in doubles, written from the headers: sums, features, layers, grey levels.
/// Whole where they are whole, so that only a feature next to a half can differ, by 1/512.
class EsiNetReference {
 public:
  explicit EsiNetReference(core::Resolution size)
      : size_(size), cells_(static_cast<std::size_t>(size.pixels())), last_s_(cells_.size(), 0.0) {}

  void process(const std::vector<core::Event>& events) {
    for (const core::Event& event : events) {
      const std::size_t at = pixel(event.x, event.y);
      const double dt_s = core::seconds(event.t) - last_s_[at];
      last_s_[at] = core::seconds(event.t);
      for (std::size_t i = 0; i < esi::kMemories; ++i) {
        const esi::Memory& m = esi::kPixelMemories[i];
        const double left = std::max(1 - double{m.rate_hz} * dt_s, 0.0);
        const double e = event.on || m.activity ? 1 : -1;
        double& sum = cells_[at][i];
        sum = m.moving ? sum * left + e : (sum + e) * left;
        sum = std::clamp(sum, -double{m.most_events}, double{m.most_events});
      }
    }
  }

  core::Image<std::uint8_t> picture(core::Time t, double levels_per_sigma) const {
    const Planes seen = features(core::seconds(t));
    const Edges edges = mixed(second_share(seen));
    const Planes second = convolved(convolved(seen, edges.layers[0]), edges.layers[1]);
    const Planes third = convolved(second, edges.layers[2]);
    const core::Image<double> shade = shade_of(second, third);
    core::Image<std::uint8_t> gray(size_);
    for (int y = 0; y < size_.height_px; ++y)
      for (int x = 0; x < size_.width_px; ++x) {
        const auto i = static_cast<std::size_t>(y % 2 * 2 + x % 2);
        double sum = edges.output_bias[i] + shade(x / 2, y / 2);
        std::vector<double> values = third(x / 2, y / 2);
        values.insert(values.end(), seen(x / 2, y / 2).begin(), seen(x / 2, y / 2).end());
        for (std::size_t k = 0; k < esi::kEsiNetOutputIn; ++k)
          sum += edges.output[i * esi::kEsiNetOutputIn + k] * values[k];
        const double sigmas = sum / (esi::kFeatureOne << esi::kEsiNetWeightBits);
        gray(x, y) = static_cast<std::uint8_t>(
            std::lround(std::clamp(127.5 + levels_per_sigma * sigmas, 0.0, 255.0)));
      }
    return gray;
  }

 private:
  using Planes = core::Image<std::vector<double>>;  // values by block

  /// esi::Convolution, or two of them mixed.
  struct Layer {
    explicit Layer(const esi::Convolution& one) : Layer(one, one, 0) {}
    Layer(const esi::Convolution& one, const esi::Convolution& other, double share)
        : in(one.in),
          shift(one.shift),
          least(one.least),
          weights(between(one.weights, other.weights, share)),
          bias(between(one.bias, other.bias, share)) {}

    int in, shift, least;
    std::vector<double> weights, bias;
  };

  struct Edges {
    std::vector<Layer> layers;
    std::vector<double> output, output_bias;
  };

  static std::vector<double> between(auto one, auto other, double share) {
    std::vector<double> values;
    for (std::size_t i = 0; i < one.size(); ++i)
      values.push_back(std::floor((1 - share) * one[i] + share * other[i] + 0.5));
    return values;
  }

  /// The two sets of weights, mixed.
  static Edges mixed(double share) {
    const auto& [one, other] = esi::esi_net_edges();
    Edges edges;
    for (std::size_t i = 0; i < one.layers.size(); ++i)
      edges.layers.emplace_back(one.layers[i], other.layers[i], share);
    edges.output = between(one.output, other.output, share);
    edges.output_bias = between(one.output_bias, other.output_bias, share);
    return edges;
  }

  /// By the features' means over all pixels of each fourth row of blocks.
  static double second_share(const Planes& seen) {
    constexpr std::size_t kFeatures = esi::kPixelFeatures;
    double z = esi::esi_net_gate()[kFeatures];
    for (std::size_t k = 0; k < kFeatures; ++k) {
      double sum = 0, count = 0;
      for (int y = 0; y < seen.height(); y += 4)
        for (int x = 0; x < seen.width(); ++x)
          for (std::size_t i = 0; i < 4; ++i, ++count) sum += seen(x, y)[i * kFeatures + k];
      z += esi::esi_net_gate()[k] * sum / count / esi::kFeatureOne;
    }
    z /= 1 << esi::kEsiNetWeightBits;
    return std::floor(256 * std::clamp(0.5 + z, 0.0, 1.0) + 0.5) / 256;
  }

  std::size_t pixel(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width_px) +
           static_cast<std::size_t>(x);
  }

  Planes features(double now_s) const {
    Planes planes({(size_.width_px + 1) / 2, (size_.height_px + 1) / 2});
    for (int y = 0; y < 2 * planes.height(); ++y)
      for (int x = 0; x < 2 * planes.width(); ++x) {
        const std::size_t at =
            pixel(std::min(x, size_.width_px - 1), std::min(y, size_.height_px - 1));
        const double age_s = now_s - last_s_[at];
        for (std::size_t i = 0; i < esi::kMemories; ++i) {
          const esi::Memory& m = esi::kPixelMemories[i];
          const double left = m.moving ? std::max(1 - double{m.rate_hz} * age_s, 0.0) : 1.0;
          const double v = cells_[at][i] * left;
          planes(x / 2, y / 2)
              .push_back(
                  whole(m.most_events > 10 ? v / (2 + std::abs(v) / 2) : 2 * v / m.most_events));
        }
        planes(x / 2, y / 2).push_back(whole(1 / (1 + 10 * age_s)));
      }
    return planes;  // rows one after the other: row by row within each block, too
  }

  static double whole(double feature) { return std::floor(esi::kFeatureOne * feature + 0.5); }

  static core::Image<double> shade_of(const Planes& second, const Planes& third) {
    Planes both = second;
    for (std::size_t i = 0; i < both.pixels().size(); ++i)
      both.pixels()[i].insert(both.pixels()[i].end(), third.pixels()[i].begin(),
                              third.pixels()[i].end());
    auto layer = esi::esi_net_shading().begin();
    std::vector<Planes> passed{both};
    for (std::size_t i = 0; i < esi::kShadingLevels; ++i)
      passed.push_back(convolved(halved(passed.back()), Layer(*layer++)));
    for (std::size_t i = esi::kShadingLevels; i > esi::kShadeLevel + 1; --i) {
      const Planes up = convolved(passed.back(), Layer(*layer++));
      passed.pop_back();
      passed.back() = sum(passed.back(), up);
    }
    const Planes last = convolved(passed.back(), Layer(*layer));
    core::Image<double> shade(last.size());
    for (std::size_t i = 0; i < last.pixels().size(); ++i)
      shade.pixels()[i] = last.pixels()[i][0] * (1 << esi::kEsiNetWeightBits);
    std::vector<core::Resolution> sizes{second.size()};
    while (sizes.back() != shade.size())
      sizes.push_back({(sizes.back().width_px + 1) / 2, (sizes.back().height_px + 1) / 2});
    for (sizes.pop_back(); !sizes.empty(); sizes.pop_back()) shade = doubled(shade, sizes.back());
    return shade;
  }

  /// Bilinear, pixels being where their middles are.
  static core::Image<double> doubled(const core::Image<double>& in, core::Resolution size) {
    core::Image<double> out(size);
    for (int y = 0; y < size.height_px; ++y)
      for (int x = 0; x < size.width_px; ++x) {
        const double at_x = std::clamp((x + 0.5) / 2 - 0.5, 0.0, in.width() - 1.0);
        const double at_y = std::clamp((y + 0.5) / 2 - 0.5, 0.0, in.height() - 1.0);
        const int left = static_cast<int>(at_x), top = static_cast<int>(at_y);
        const int right = std::min(left + 1, in.width() - 1);
        const int bottom = std::min(top + 1, in.height() - 1);
        const double u = at_x - left, v = at_y - top;
        out(x, y) = (1 - v) * ((1 - u) * in(left, top) + u * in(right, top)) +
                    v * ((1 - u) * in(left, bottom) + u * in(right, bottom));
      }
    return out;
  }

  static Planes halved(const Planes& in) {
    Planes out({(in.width() + 1) / 2, (in.height() + 1) / 2},
               std::vector<double>(in(0, 0).size(), 0.0));
    for (int y = 0; y < 2 * out.height(); ++y)
      for (int x = 0; x < 2 * out.width(); ++x)
        for (std::size_t k = 0; k < in(0, 0).size(); ++k)
          out(x / 2, y / 2)[k] +=
              in(std::min(x, in.width() - 1), std::min(y, in.height() - 1))[k] / 4;
    for (std::vector<double>& values : out.pixels())
      for (double& value : values) value = std::floor(value + 0.5);
    return out;
  }

  static Planes sum(const Planes& fine, const Planes& coarse) {
    Planes out = fine;
    for (int y = 0; y < out.height(); ++y)
      for (int x = 0; x < out.width(); ++x)
        for (std::size_t k = 0; k < esi::kConvolutionOut; ++k)
          out(x, y)[k] += coarse(x / 2, y / 2)[k];
    return out;
  }

  static Planes convolved(const Planes& in, const Layer& layer) {
    Planes out(in.size(), std::vector<double>(esi::kConvolutionOut));
    for (int y = 0; y < in.height(); ++y)
      for (int x = 0; x < in.width(); ++x)
        for (std::size_t to = 0; to < esi::kConvolutionOut; ++to) {
          const double sum = sum_at(in, layer, x, y, to) / (1 << layer.shift);
          out(x, y)[to] =
              std::clamp(std::floor(sum + 0.5), double(layer.least), double{esi::kMostValue});
        }
    return out;
  }

  static double sum_at(const Planes& in, const Layer& layer, int x, int y, std::size_t to) {
    double sum = layer.bias[to];
    const std::size_t channels = static_cast<std::size_t>(layer.in);
    for (int n = 0; n < 9; ++n) {
      const int from_x = x + n % 3 - 1, from_y = y + n / 3 - 1;
      if (from_x < 0 || from_x >= in.width() || from_y < 0 || from_y >= in.height()) continue;
      for (std::size_t k = 0; k < channels; ++k) {
        const std::size_t pair = static_cast<std::size_t>(n) * channels / 2 + k / 2;
        sum +=
            layer.weights[(pair * esi::kConvolutionOut + to) * 2 + k % 2] * in(from_x, from_y)[k];
      }
    }
    return sum;
  }

  core::Resolution size_;
  std::vector<std::array<double, esi::kMemories>> cells_;
  std::vector<double> last_s_;
};

}  // namespace nightjar::test
