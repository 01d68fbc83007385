#include "esi/quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

namespace nightjar::esi {
namespace {

constexpr int kWindow_px = 11;
constexpr double kSigma_px = 1.5;
constexpr double kWhite = 255;

std::string text(core::Resolution size) {
  return std::to_string(size.width_px) + "x" + std::to_string(size.height_px);
}

void check(core::Resolution picture, core::Resolution reference) {
  if (picture != reference)
    throw std::invalid_argument("picture of " + text(picture) + " px, allowed " + text(reference) +
                                " as the reference has");
  if (std::min(picture.width_px, picture.height_px) < kWindow_px)
    throw std::invalid_argument("picture of " + text(picture) + " px, allowed from " +
                                text({kWindow_px, kWindow_px}) + " on");
}

double mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Gain and offset of the straight line through (picture, reference) of all pixels.
void fit(std::span<const double> picture, std::span<const double> reference, Quality& quality) {
  const double mean_p = mean(picture), mean_r = mean(reference);
  double variance = 0, covariance = 0;
  for (std::size_t i = 0; i < picture.size(); ++i) {
    variance += (picture[i] - mean_p) * (picture[i] - mean_p);
    covariance += (picture[i] - mean_p) * (reference[i] - mean_r);
  }
  quality.gain = variance > 0 ? std::max(covariance / variance, 0.0) : 0.0;
  quality.offset_levels = mean_r - quality.gain * mean_p;
}

std::array<double, kWindow_px> window() {
  std::array<double, kWindow_px> weights;
  for (int i = 0; i < kWindow_px; ++i) {
    const double d = (i - kWindow_px / 2) / kSigma_px;
    weights[static_cast<std::size_t>(i)] = std::exp(-0.5 * d * d);
  }
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// Values laid out as a picture's; the window's mean wherever it fits whole.
std::vector<double> local_mean(const std::vector<double>& values, core::Resolution size) {
  static const std::array<double, kWindow_px> weights = window();
  const int width = size.width_px - kWindow_px + 1, height = size.height_px - kWindow_px + 1;
  const auto at = [](const double* row, std::size_t stride) {
    double sum = 0;
    for (std::size_t i = 0; i < kWindow_px; ++i) sum += weights[i] * row[i * stride];
    return sum;
  };
  std::vector<double> across, both;
  for (int y = 0; y < size.height_px; ++y)
    for (int x = 0; x < width; ++x) across.push_back(at(&values[y * size.width_px + x], 1));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      both.push_back(at(&across[y * width + x], static_cast<std::size_t>(width)));
  return both;
}

std::vector<double> product(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> out(a.size());
  std::transform(a.begin(), a.end(), b.begin(), out.begin(), std::multiplies<>());
  return out;
}

// Wang et al. 2004, eq. 13, averaged as in eq. 17.
double mean_ssim(const std::vector<double>& a, const std::vector<double>& b,
                 core::Resolution size) {
  constexpr double kC1 = (0.01 * kWhite) * (0.01 * kWhite), kC2 = (0.03 * kWhite) * (0.03 * kWhite);
  const auto mean_a = local_mean(a, size), mean_b = local_mean(b, size);
  const auto mean_aa = local_mean(product(a, a), size), mean_bb = local_mean(product(b, b), size);
  const auto mean_ab = local_mean(product(a, b), size);
  double sum = 0;
  for (std::size_t i = 0; i < mean_a.size(); ++i) {
    const double ma = mean_a[i], mb = mean_b[i];
    const double variances = mean_aa[i] - ma * ma + mean_bb[i] - mb * mb;
    const double covariance = mean_ab[i] - ma * mb;
    sum += (2 * ma * mb + kC1) * (2 * covariance + kC2) /
           ((ma * ma + mb * mb + kC1) * (variances + kC2));
  }
  return sum / static_cast<double>(mean_a.size());
}

}  // namespace

Quality compare(const core::Image<std::uint8_t>& picture,
                const core::Image<std::uint8_t>& reference) {
  check(picture.size(), reference.size());
  std::vector<double> fitted(picture.pixels().begin(), picture.pixels().end());
  const std::vector<double> wanted(reference.pixels().begin(), reference.pixels().end());
  Quality quality;
  fit(fitted, wanted, quality);
  double sum_of_squares = 0;
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    fitted[i] = quality.gain * fitted[i] + quality.offset_levels;
    sum_of_squares += (fitted[i] - wanted[i]) * (fitted[i] - wanted[i]);
  }
  quality.mse = sum_of_squares / static_cast<double>(fitted.size());
  quality.psnr_db = quality.mse > 0 ? 10 * std::log10(kWhite * kWhite / quality.mse)
                                    : std::numeric_limits<double>::infinity();
  quality.ssim = mean_ssim(fitted, wanted, picture.size());
  return quality;
}

}  // namespace nightjar::esi
