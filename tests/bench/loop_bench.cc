#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "scenarios/loop.h"
#include "scenarios/scenario.h"

namespace nightjar::scenarios {
namespace {

/// The whole loop over the landing scenario's first second; loading the scene and
/// writing the files is part of it.
void fly_one_second(benchmark::State& state, double max_motion_px, sim::SensorPreset preset,
                    double illuminance_lux) {
  Scenario scenario = load(NIGHTJAR_SOURCE_DIR "/scenarios/tracking_landing.yaml");
  scenario.duration_s = 1;
  scenario.world.renderer.max_motion_px = max_motion_px;
  scenario.sensor.preset = preset;
  scenario.illuminance_lux = illuminance_lux;
  RunOptions options;
  options.out =
      std::filesystem::temp_directory_path() / ("nightjar_bench_" + std::to_string(getpid()));
  options.video = false;
  for (auto _ : state) benchmark::DoNotOptimize(run(scenario, options));
  std::filesystem::remove_all(options.out);
}

void simulated_second(benchmark::State& state, sim::SensorPreset preset, double illuminance_lux) {
  fly_one_second(state, 0.5, preset, illuminance_lux);
}

/// Nearly every physics step is drawn, so that nothing is left to interpolate.
void simulated_second_reference(benchmark::State& state, sim::SensorPreset preset,
                                double illuminance_lux) {
  fly_one_second(state, 0.05, preset, illuminance_lux);
}

#define NIGHTJAR_BENCHMARK_SECOND(function)                            \
  BENCHMARK_CAPTURE(function, dim, sim::SensorPreset::dim, 5.0)        \
      ->Unit(benchmark::kMillisecond)                                  \
      ->UseRealTime();                                                 \
  BENCHMARK_CAPTURE(function, clean, sim::SensorPreset::clean, 1000.0) \
      ->Unit(benchmark::kMillisecond)                                  \
      ->UseRealTime()
NIGHTJAR_BENCHMARK_SECOND(simulated_second);
NIGHTJAR_BENCHMARK_SECOND(simulated_second_reference);
#undef NIGHTJAR_BENCHMARK_SECOND

}  // namespace
}  // namespace nightjar::scenarios
