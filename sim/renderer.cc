#include "sim/renderer.h"

#include <GL/osmesa.h>
#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace nightjar::sim {
namespace {

constexpr int kMaxGeoms = 500;
constexpr int kGroupUav = 1;
constexpr int kFontScale = 100;
constexpr int kChannels = 4;  // OSMesa draws RGBA

// Rec. ITU-R BT.709, luma coefficients.
constexpr float kRed = 0.2126f, kGreen = 0.7152f, kBlue = 0.0722f;

OSMesaContext create_context() {
  // llvmpipe filters 8-bit textures in 8-bit arithmetic unless told otherwise, and
  // reads this before its first context: without it a drawn float picture has some
  // 200 different values, with it as many as pixels.
  setenv("GALLIVM_PERF", "no_aos_sampling", 1);
  const std::array<int, 5> attributes = {OSMESA_FORMAT, OSMESA_RGBA, OSMESA_DEPTH_BITS, 24, 0};
  OSMesaContext context = OSMesaCreateContextAttribs(attributes.data(), nullptr);
  if (context == nullptr)
    throw std::runtime_error("OSMesa gave no context; is libosmesa6 installed?");
  return context;
}

}  // namespace

/// OSMesa's context and buffer, MuJoCo's scene and its GL resources.
struct Renderer::Gl {
  OSMesaContext context = create_context();
  std::vector<float> rgba;
  mjvScene geoms{};
  mjvOption option{};
  mjrContext resources{};

  ~Gl() {
    mjr_freeContext(&resources);
    mjv_freeScene(&geoms);
    OSMesaDestroyContext(context);
  }

  void target(core::Resolution size) {
    rgba.resize(static_cast<std::size_t>(kChannels * size.pixels()));
    if (OSMesaMakeCurrent(context, rgba.data(), GL_FLOAT, size.width_px, size.height_px) != GL_TRUE)
      throw std::runtime_error(
          fmt::format("OSMesa cannot draw {}x{} floats", size.width_px, size.height_px));
    OSMesaPixelStore(OSMESA_Y_UP, 0);  // top row first
  }

  void draw(Scene& scene, mjvCamera& camera, bool with_uav, core::Resolution size) {
    target(size);
    option.geomgroup[kGroupUav] = with_uav;
    mjv_updateScene(scene.model(), scene.data(), &option, nullptr, &camera, mjCAT_ALL, &geoms);
    mjr_render({0, 0, size.width_px, size.height_px}, &geoms, &resources);
    glFinish();
  }
};

Renderer::Renderer(Scene& scene, core::Resolution size, int supersampling)
    : gl_(std::make_unique<Gl>()), size_(size), supersampling_(supersampling) {
  gl_->target({size.width_px * supersampling, size.height_px * supersampling});
  description_ = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  if (description_.find("llvmpipe") == std::string::npos)
    throw std::runtime_error(
        fmt::format("OSMesa draws with '{}', wanted llvmpipe: unset GALLIUM_DRIVER", description_));

  mjv_defaultScene(&gl_->geoms);
  mjv_makeScene(scene.model(), &gl_->geoms, kMaxGeoms);
  for (const int flag : {mjRND_SHADOW, mjRND_REFLECTION, mjRND_SKYBOX, mjRND_HAZE, mjRND_FOG})
    gl_->geoms.flags[flag] = 0;
  mjv_defaultOption(&gl_->option);
  for (int group = 0; group < mjNGROUP; ++group) gl_->option.geomgroup[group] = group <= kGroupUav;
  mjr_defaultContext(&gl_->resources);
  mjr_makeContext(scene.model(), &gl_->resources, kFontScale);
  mjr_setBuffer(mjFB_WINDOW, &gl_->resources);
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
  const float* sample = gl_->rgba.data();
  const std::size_t row = static_cast<std::size_t>(kChannels * n * size_.width_px);
  const float weight = static_cast<float>(white_lux) / static_cast<float>(n * n);
  for (int y = 0; y < size_.height_px; ++y)
    for (int x = 0; x < size_.width_px; ++x) {
      float sum = 0;
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          const float* rgba = sample + static_cast<std::size_t>(y * n + j) * row +
                              static_cast<std::size_t>(kChannels * (x * n + i));
          sum += kRed * rgba[0] + kGreen * rgba[1] + kBlue * rgba[2];
        }
      luminance_lux(x, y) = weight * sum;
    }
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
  const float* rgba = gl_->rgba.data();
  for (Rgb& pixel : view.pixels()) {
    for (int c = 0; c < 3; ++c)
      pixel[c] = static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(rgba[c], 0.0f, 1.0f)));
    rgba += kChannels;
  }
}

}  // namespace nightjar::sim
