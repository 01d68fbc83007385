#include <benchmark/benchmark.h>

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "esi/make_reconstructor.h"
#include "scenarios/event_workloads.h"
#include "scenarios/reconstruction_speed.h"

// A million events through each reconstruction method, on six workloads, without pictures
// and with one every 10 ms of the events' time; beside them ESI in doubles and std::pow (the
// reference) and the bound: to read each event and touch its cell. The counter tells million
// events a second. `nightjar bench` prints the same as a table.

namespace nightjar {
namespace {

/// Together more than any cache holds, little enough for all six to be there at a time.
constexpr std::size_t kEvents = 6'000'000;
constexpr double kMost_s = 0.1;

const scenarios::EventWorkload& workload(std::size_t index) {
  static std::map<std::size_t, scenarios::EventWorkload> made;
  if (!made.contains(index)) made.emplace(index, scenarios::make_workload(index, kEvents));
  return made.at(index);
}

using MakeSubject =
    std::function<std::unique_ptr<scenarios::SpeedSubject>(const scenarios::EventWorkload&)>;

void add(const std::string& name, std::size_t index, bool pictures, const MakeSubject& make) {
  const auto measure = [=](benchmark::State& state) {
    const auto subject = make(workload(index));
    for (auto _ : state) {
      const double rate_hz = measure_rate_hz(*subject, workload(index), pictures, kMost_s);
      state.SetIterationTime(1e6 / rate_hz);
      state.counters["MevPerS"] = 1e-6 * rate_hz;
    }
  };
  std::string place = scenarios::workload_name(index) + (pictures ? " with pictures" : "");
  for (char& c : place)
    if (c == ' ' || c == '/') c = '_';
  benchmark::RegisterBenchmark(("reconstruct/" + place + "/" + name).c_str(), measure)
      ->UseManualTime()
      ->Iterations(1)
      ->Unit(benchmark::kMillisecond);
}

void add_all(std::size_t index, bool pictures) {
  const auto configured = [](esi::Method method) {
    esi::ReconstructorConfig config;
    config.method = method;
    return config;
  };
  add("_reference", index, pictures,
      [](const auto& w) { return scenarios::reference_subject(esi::EsiConfig{}, w.size); });
  for (const auto& [name, method] : esi::kMethods)
    if (!esi::is_network(method))
      add(name, index, pictures, [=, config = configured(method)](const auto& w) {
        return scenarios::method_subject(config, w.size);
      });
  add("esi_16_byte_events", index, pictures,
      [=](const auto& w) { return scenarios::unpacked_subject(configured(esi::Method::esi), w); });
  if (!pictures)
    add("bound", index, pictures, [](const auto& w) { return scenarios::bound_subject(w.size); });
}

const bool added = [] {
  for (std::size_t index = 0; index < scenarios::kWorkloads; ++index)
    for (const bool pictures : {false, true}) add_all(index, pictures);
  return true;
}();

}  // namespace
}  // namespace nightjar
