#include "sim/renderer.h"

#include <GL/gl.h>
#include <GL/glext.h>
#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <stdexcept>

namespace nightjar::sim {
namespace {

// All light is dimmed by this, so that 16 bits reach up to kBrightest.
constexpr float kDimming = static_cast<float>(1 / Renderer::kBrightest);
constexpr float kMostCode = 65535;

core::Resolution scaled(core::Resolution size, int factor) {
  return {size.width_px * factor, size.height_px * factor};
}

bool is_gray(const float* rgb) { return rgb[0] == rgb[1] && rgb[1] == rgb[2]; }

void check_lights(const mjvScene& geoms) {
  float sum = 0;
  for (int i = 0; i < geoms.nlight; ++i) {
    const mjvLight& light = geoms.lights[i];
    for (const float* rgb : {light.ambient, light.diffuse, light.specular})
      if (!is_gray(rgb))
        throw std::invalid_argument(fmt::format(
            "light {} of the scene is coloured ({:g} {:g} {:g}), allowed grey: the sensor sees "
            "luminance alone",
            i, rgb[0], rgb[1], rgb[2]));
    sum += light.ambient[0] + light.diffuse[0];
  }
  if (sum > Renderer::kBrightest)
    throw std::invalid_argument(fmt::format(
        "the scene's lights (ambient + diffuse) add up to {:.3g}, allowed 0 to {:g}: a white "
        "surface would be cut off; how bright it is in lux is the scenario's illuminance_lux",
        sum, Renderer::kBrightest));
}

void dim(mjvScene& geoms) {
  for (int i = 0; i < geoms.nlight; ++i)
    for (float* light :
         {geoms.lights[i].ambient, geoms.lights[i].diffuse, geoms.lights[i].specular})
      for (int c = 0; c < 3; ++c) light[c] *= kDimming;
  for (int i = 0; i < geoms.ngeom; ++i) geoms.geoms[i].emission *= kDimming;
}

void to_luminance(std::span<const std::uint16_t> codes, float lux_per_code,
                  std::span<float> luminance_lux) {
  for (std::size_t i = 0; i < luminance_lux.size(); ++i)
    luminance_lux[i] = lux_per_code * static_cast<float>(codes[i]);
}

/// The same with n x n samples a pixel, added up.
void to_mean_luminance(std::span<const std::uint16_t> rows, std::size_t n, float lux_per_code,
                       std::span<float> luminance_lux) {
  std::ranges::fill(luminance_lux, 0.0f);
  const float lux_per_sample = lux_per_code / static_cast<float>(n * n);
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < luminance_lux.size(); ++i)
      for (const std::uint16_t code : rows.subspan((j * luminance_lux.size() + i) * n, n))
        luminance_lux[i] += lux_per_sample * static_cast<float>(code);
}

}  // namespace

Renderer::Renderer(Scene& scene, core::Resolution size, int supersampling)
    : size_(size),
      supersampling_(supersampling),
      off_screen_(*scene.model(), scaled(size, supersampling), GL_R16),
      view_(scene),
      codes_(static_cast<std::size_t>(off_screen_.size().pixels())) {
  view_.look_at(scene, {0, 0, 0}, 1, 0, 0);
  check_lights(view_.geoms());
}

void Renderer::draw(const View& view, double white_lux, core::Image<float>& luminance_lux) {
  mjvScene drawn = view.geoms();
  std::vector<mjvGeom> geoms(drawn.geoms, drawn.geoms + drawn.ngeom);
  drawn.geoms = geoms.data();
  dim(drawn);
  const OffScreen::Current current(off_screen_);
  materials_.apply(off_screen_.resources(), drawn);
  off_screen_.render(drawn);
  const core::Resolution samples = off_screen_.size();
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, samples.width_px, samples.height_px, GL_RED, GL_UNSIGNED_SHORT, codes_.data());

  if (luminance_lux.size() != size_) luminance_lux = core::Image<float>(size_);
  const float lux_per_code = static_cast<float>(white_lux) / kDimming / kMostCode;
  const auto width = static_cast<std::size_t>(size_.width_px);
  const auto n = static_cast<std::size_t>(supersampling_);
  for (int y = 0; y < size_.height_px; ++y) {
    const std::size_t from_bottom = static_cast<std::size_t>(size_.height_px - 1 - y);
    const auto rows =
        std::span<const std::uint16_t>(codes_).subspan(from_bottom * width * n * n, width * n * n);
    const auto row = luminance_lux.pixels().subspan(static_cast<std::size_t>(y) * width, width);
    if (n == 1)
      to_luminance(rows, lux_per_code, row);
    else
      to_mean_luminance(rows, n, lux_per_code, row);
  }
}

void Renderer::draw(Scene& scene, int camera, double white_lux, core::Image<float>& luminance_lux) {
  view_.look(scene, camera);
  draw(view_, white_lux, luminance_lux);
}

}  // namespace nightjar::sim
