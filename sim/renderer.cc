#include "sim/renderer.h"

#include <GL/osmesa.h>
#include <fmt/format.h>
#include <mujoco/mujoco.h>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <span>
#include <stdexcept>
#include <vector>

namespace nightjar::sim {
namespace {

constexpr int kMaxGeoms = 500;
constexpr int kGroupUav = 1;
constexpr int kFontScale = 100;
constexpr int kChannels = 4;  // OSMesa draws RGBA

// Rec. ITU-R BT.709, luma coefficients.
constexpr float kRed = 0.2126f, kGreen = 0.7152f, kBlue = 0.0722f;

// All light is dimmed by this, so that 16-bit channels reach up to kBrightest.
constexpr float kDimming = static_cast<float>(1 / Renderer::kBrightest);
constexpr int kMostCode = 65535;

OSMesaContext create_context() {
  // llvmpipe filters 8-bit textures in 8-bit arithmetic unless told otherwise, and
  // reads this before its first context: without it a drawn picture has some 200
  // different values, with it 50 times as many.
  setenv("GALLIVM_PERF", "no_aos_sampling", 1);
  // Draws on the calling thread: the camera's and the messages' threads have use for the
  // other cores, and waiting for llvmpipe's own threads costs more than they gain
  // (docs/rendering.md). Whoever sets the variable decides for himself.
  setenv("LP_NUM_THREADS", "0", 0);
  const std::array<int, 5> attributes = {OSMESA_FORMAT, OSMESA_RGBA, OSMESA_DEPTH_BITS, 24, 0};
  OSMesaContext context = OSMesaCreateContextAttribs(attributes.data(), nullptr);
  if (context == nullptr) throw std::runtime_error("OSMesa gave no context to draw in");
  return context;
}

void to_luminance(const std::uint16_t* rgba, float lux_per_code, std::span<float> luminance_lux) {
  const float red = kRed * lux_per_code, green = kGreen * lux_per_code, blue = kBlue * lux_per_code;
  float* out = luminance_lux.data();
  const std::size_t count = luminance_lux.size();
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i)
    out[i] = red * rgba[kChannels * i] + green * rgba[kChannels * i + 1] +
             blue * rgba[kChannels * i + 2];
}

/// The same with n x n samples a pixel, added up.
void to_mean_luminance(const std::uint16_t* rgba, int n, float lux_per_code,
                       core::Image<float>& luminance_lux) {
  std::vector<float> row(static_cast<std::size_t>(n * luminance_lux.width()));
  for (int y = 0; y < luminance_lux.height(); ++y)
    for (int j = 0; j < n; ++j, rgba += kChannels * row.size()) {
      to_luminance(rgba, lux_per_code, row);
      for (int x = 0; x < luminance_lux.width(); ++x) {
        const auto first = row.begin() + n * x;
        luminance_lux(x, y) = std::accumulate(first, first + n, j > 0 ? luminance_lux(x, y) : 0.0f);
      }
    }
}

}  // namespace

/// OSMesa's context and buffer, MuJoCo's scene and its GL resources.
struct Renderer::Gl {
  OSMesaContext context = create_context();
  std::vector<std::uint16_t> rgba = std::vector<std::uint16_t>(kChannels);
  mjvScene geoms{};
  mjvOption option{};
  mjrContext resources{};

  ~Gl() {
    // What is freed is numbered by context: another renderer's must not be the current one.
    OSMesaMakeCurrent(context, rgba.data(), GL_UNSIGNED_SHORT, 1, 1);
    mjr_freeContext(&resources);
    mjv_freeScene(&geoms);
    OSMesaDestroyContext(context);
  }

  void target(core::Resolution size) {
    rgba.resize(static_cast<std::size_t>(kChannels * size.pixels()));
    if (OSMesaMakeCurrent(context, rgba.data(), GL_UNSIGNED_SHORT, size.width_px, size.height_px) !=
        GL_TRUE)
      throw std::runtime_error(
          fmt::format("OSMesa cannot draw {}x{} px of 16 bits", size.width_px, size.height_px));
    OSMesaPixelStore(OSMESA_Y_UP, 0);  // top row first
  }

  void update(Scene& scene, mjvCamera& camera, bool with_uav) {
    option.geomgroup[kGroupUav] = with_uav;
    mjv_updateScene(scene.model(), scene.data(), &option, nullptr, &camera, mjCAT_ALL, &geoms);
  }

  void dim() {
    for (int i = 0; i < geoms.nlight; ++i)
      for (float* light :
           {geoms.lights[i].ambient, geoms.lights[i].diffuse, geoms.lights[i].specular})
        for (int c = 0; c < 3; ++c) light[c] *= kDimming;
    for (int i = 0; i < geoms.ngeom; ++i) geoms.geoms[i].emission *= kDimming;
  }

  /// Nearest first, so that what it hides need not be shaded. The picture is the same.
  void sort() {
    const Eigen::Map<const Eigen::Vector3f> eye(geoms.camera[0].pos);
    const auto distance = [&eye](const mjvGeom& geom) {
      return (Eigen::Map<const Eigen::Vector3f>(geom.pos) - eye).squaredNorm();
    };
    std::stable_sort(geoms.geoms, geoms.geoms + geoms.ngeom,
                     [&](const mjvGeom& a, const mjvGeom& b) { return distance(a) < distance(b); });
  }

  void draw(Scene& scene, mjvCamera& camera, bool with_uav, core::Resolution size) {
    target(size);
    update(scene, camera, with_uav);
    dim();
    sort();
    mjr_render({0, 0, size.width_px, size.height_px}, &geoms, &resources);
    glFinish();
  }
};

Renderer::Renderer(Scene& scene, core::Resolution size, int supersampling)
    : gl_(std::make_unique<Gl>()), size_(size), supersampling_(supersampling) {
  gl_->target({size.width_px * supersampling, size.height_px * supersampling});
  check_llvmpipe();
  mjv_defaultScene(&gl_->geoms);
  mjv_makeScene(scene.model(), &gl_->geoms, kMaxGeoms);
  for (const int flag : {mjRND_SHADOW, mjRND_REFLECTION, mjRND_SKYBOX, mjRND_HAZE, mjRND_FOG})
    gl_->geoms.flags[flag] = 0;
  mjv_defaultOption(&gl_->option);
  for (int group = 0; group < mjNGROUP; ++group)
    gl_->option.geomgroup[group] = group == kSensorGroup || group == kGroupUav;
  mjr_defaultContext(&gl_->resources);
  mjr_makeContext(scene.model(), &gl_->resources, kFontScale);
  mjr_setBuffer(mjFB_WINDOW, &gl_->resources);
  check_lights(scene);
}

void Renderer::check_llvmpipe() {
  description_ = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  if (description_.find("llvmpipe") == std::string::npos)
    throw std::runtime_error(
        fmt::format("OSMesa draws with '{}', wanted llvmpipe: unset GALLIUM_DRIVER", description_));
}

void Renderer::check_lights(Scene& scene) {
  mjvCamera camera;
  mjv_defaultCamera(&camera);
  gl_->update(scene, camera, false);
  std::array<double, 3> sum{};
  for (int i = 0; i < gl_->geoms.nlight; ++i)
    for (int c = 0; c < 3; ++c)
      sum[c] += gl_->geoms.lights[i].ambient[c] + gl_->geoms.lights[i].diffuse[c];
  const double most = *std::max_element(sum.begin(), sum.end());
  if (most > kBrightest)
    throw std::invalid_argument(fmt::format(
        "the scene's lights (ambient + diffuse) add up to {:.3g}, allowed 0 to {:g}: a white "
        "surface would be cut off; how bright it is in lux is the scenario's illuminance_lux",
        most, kBrightest));
}

Renderer::~Renderer() = default;

void Renderer::draw(Scene& scene, int camera_id, double white_lux,
                    core::Image<float>& luminance_lux) {
  mjvCamera camera;
  mjv_defaultCamera(&camera);
  camera.type = mjCAMERA_FIXED;
  camera.fixedcamid = camera_id;
  const int n = supersampling_;
  gl_->draw(scene, camera, false, {size_.width_px * n, size_.height_px * n});

  if (luminance_lux.size() != size_) luminance_lux = core::Image<float>(size_);
  const float lux_per_code = static_cast<float>(white_lux) / kDimming / kMostCode;
  const std::uint16_t* rgba = gl_->rgba.data();
  if (n == 1)
    to_luminance(rgba, lux_per_code, luminance_lux.pixels());
  else
    to_mean_luminance(rgba, n, lux_per_code / static_cast<float>(n * n), luminance_lux);
}

void Renderer::draw_view(Scene& scene, const std::array<double, 3>& look_at_m, double distance_m,
                         double azimuth_deg, double elevation_deg, core::Image<Rgb>& view) {
  mjvCamera camera;
  mjv_defaultCamera(&camera);
  camera.type = mjCAMERA_FREE;
  std::copy(look_at_m.begin(), look_at_m.end(), camera.lookat);
  camera.distance = distance_m;
  camera.azimuth = azimuth_deg;
  camera.elevation = elevation_deg;
  gl_->draw(scene, camera, true, view.size());
  const std::uint16_t* rgba = gl_->rgba.data();
  constexpr float kGrayPerCode = 255.0f / (kDimming * kMostCode);
  for (Rgb& pixel : view.pixels()) {
    for (int c = 0; c < 3; ++c)
      pixel[c] = static_cast<std::uint8_t>(std::min(std::lround(kGrayPerCode * rgba[c]), 255L));
    rgba += kChannels;
  }
}

}  // namespace nightjar::sim
