#include <GL/osmesa.h>
#include <benchmark/benchmark.h>
#include <mujoco/mujoco.h>

#include <array>
#include <filesystem>
#include <vector>

#include "sim/renderer.h"
#include "tests/support/sim_scene.h"

namespace nightjar::sim {
namespace {

constexpr core::Resolution kSize{346, 260};

/// MuJoCo's usual way off-screen: its own frame buffer, 8 bits, with what shadows and
/// reflections the scene asks for, then read back.
void rendered_frame_reference(benchmark::State& state) {
  Scene scene(test::arena());
  const std::array<int, 5> attributes = {OSMESA_FORMAT, OSMESA_RGBA, OSMESA_DEPTH_BITS, 24, 0};
  const OSMesaContext context = OSMesaCreateContextAttribs(attributes.data(), nullptr);
  std::vector<unsigned char> window(4 * kSize.pixels()), rgb(3 * kSize.pixels());
  OSMesaMakeCurrent(context, window.data(), GL_UNSIGNED_BYTE, kSize.width_px, kSize.height_px);
  scene.model()->vis.global.offwidth = kSize.width_px;
  scene.model()->vis.global.offheight = kSize.height_px;
  mjvScene geoms;
  mjvOption option;
  mjvCamera camera;
  mjrContext resources;
  mjv_defaultScene(&geoms);
  mjv_makeScene(scene.model(), &geoms, 500);
  mjv_defaultOption(&option);
  mjv_defaultCamera(&camera);
  mjr_defaultContext(&resources);
  mjr_makeContext(scene.model(), &resources, 100);
  mjr_setBuffer(mjFB_OFFSCREEN, &resources);
  camera.type = mjCAMERA_FIXED;
  camera.fixedcamid = scene.id(mjOBJ_CAMERA, "dvs");
  for (auto _ : state) {
    mjv_updateScene(scene.model(), scene.data(), &option, nullptr, &camera, mjCAT_ALL, &geoms);
    mjr_render({0, 0, kSize.width_px, kSize.height_px}, &geoms, &resources);
    mjr_readPixels(rgb.data(), nullptr, {0, 0, kSize.width_px, kSize.height_px}, &resources);
  }
  mjr_freeContext(&resources);
  mjv_freeScene(&geoms);
  OSMesaDestroyContext(context);
}
BENCHMARK(rendered_frame_reference)->Unit(benchmark::kMillisecond)->UseRealTime();

void rendered_frame(benchmark::State& state) {
  Scene scene(test::arena());
  Renderer renderer(scene, kSize, static_cast<int>(state.range(0)));
  core::Image<float> luminance_lux;
  const int camera = scene.id(mjOBJ_CAMERA, "dvs");
  for (auto _ : state) renderer.draw(scene, camera, 5.0, luminance_lux);
}
BENCHMARK(rendered_frame)
    ->ArgName("supersampling")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace nightjar::sim
