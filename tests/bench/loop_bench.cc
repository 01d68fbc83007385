#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "scenarios/loop.h"
#include "scenarios/scenario.h"

namespace nightjar::scenarios {
namespace {

/// The whole loop, files and all, over the landing scenario's first second.
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

/// All but a physics step apart, so that nothing is left to interpolate.
void simulated_second_reference(benchmark::State& state) {
  fly_one_second(state, 0.05, sim::SensorPreset::dim, 5);
}
BENCHMARK(simulated_second_reference)->Unit(benchmark::kMillisecond)->UseRealTime();

void simulated_second_dim(benchmark::State& state) {
  fly_one_second(state, 0.5, sim::SensorPreset::dim, 5);
}
BENCHMARK(simulated_second_dim)->Unit(benchmark::kMillisecond)->UseRealTime();

void simulated_second_clean(benchmark::State& state) {
  fly_one_second(state, 0.5, sim::SensorPreset::clean, 1000);
}
BENCHMARK(simulated_second_clean)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace nightjar::scenarios
