#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <vector>

#include "sim/emulator.h"
#include "tests/support/sim_moving_texture.h"
#include "tests/support/sim_scalar_emulator.h"

// One step of the event pixels, 346x260, everything on, a moving scene with about 1.2
// million events a second; the counters tell the events a step and, in `Ratio`, how many
// times as long the plain scalar reference takes in the same run.

namespace nightjar {
namespace {

constexpr core::Resolution kSize{346, 260};
constexpr core::Time kStep(2300);
constexpr double kWhite_lux = 5.0;

/// CPU time of this thread: what others do on the machine counts less.
double cpu_s() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// An emulator before a scene that moves on with each step.
template <class Emulator>
class Run {
 public:
  explicit Run(sim::SensorPreset preset)
      : emulator_(sim::preset_pixel(preset, kWhite_lux), kSize, kWhite_lux, 1) {
    const test::MovingTexture scene(kWhite_lux);
    for (int i = 0; i < test::MovingTexture::kSteps; ++i)
      frames_.push_back(scene.luminance_lux(kSize, i));
    for (int i = 0; i < test::MovingTexture::kSteps; ++i) step();  // thresholds settle
    events_in_all_ = 0;
    steps_ = 0;
  }

  /// Returns what the step took.
  double step() {
    // As after rendering, the picture is fresh in the cache.
    std::ranges::copy(frames_[next_++ % frames_.size()].pixels(), frame_.pixels().begin());
    events_.clear();
    const double begin_s = cpu_s();
    emulator_.step(t_ += kStep, frame_, events_);
    const double took_s = cpu_s() - begin_s;
    events_in_all_ += events_.size();
    ++steps_;
    return took_s;
  }

  double events_per_step() const {
    return static_cast<double>(events_in_all_) / static_cast<double>(steps_);
  }

 private:
  Emulator emulator_;
  std::vector<core::Image<float>> frames_;
  core::Image<float> frame_{kSize};
  std::vector<core::Event> events_;
  core::Time t_{};
  std::size_t next_ = 0, events_in_all_ = 0, steps_ = 0;
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void emulator_step(benchmark::State& state, sim::SensorPreset preset) {
  Run<sim::EventEmulator> run(preset);
  std::vector<double> took_us;
  for (auto _ : state) {
    const double took_s = run.step();
    state.SetIterationTime(took_s);
    took_us.push_back(1e6 * took_s);
  }
  state.counters["Events"] = run.events_per_step();
  state.counters["MedianUs"] = median(took_us);
}
BENCHMARK_CAPTURE(emulator_step, dim, sim::SensorPreset::dim)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(emulator_step, clean, sim::SensorPreset::clean)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);

/// The time is the plain reference's.
void emulator_step_reference(benchmark::State& state, sim::SensorPreset preset) {
  Run<sim::EventEmulator> fast(preset);
  Run<test::ScalarEmulator> plain(preset);
  std::vector<double> fast_us, plain_us;
  for (auto _ : state) {  // in turn, so that both meet the same machine
    for (int i = 0; i < 10; ++i) fast_us.push_back(1e6 * fast.step());
    const double took_s = plain.step();
    state.SetIterationTime(took_s);
    plain_us.push_back(1e6 * took_s);
  }
  state.counters["Events"] = plain.events_per_step();
  state.counters["MedianUs"] = median(plain_us);
  state.counters["Ratio"] = median(plain_us) / median(fast_us);
}
BENCHMARK_CAPTURE(emulator_step_reference, dim, sim::SensorPreset::dim)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(emulator_step_reference, clean, sim::SensorPreset::clean)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace nightjar
