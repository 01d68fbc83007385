// Any method, fed any events, frames, pictures and resets, refuses with an invalid_argument of
// one line or goes on, and afterwards still takes an event and draws. Anything else is
// a finding.
#include <fuzzer/FuzzedDataProvider.h>

#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "esi/make_reconstructor.h"

namespace {

using namespace nightjar;

constexpr core::Resolution kSizes[] = {{1, 1}, {2, 3}, {17, 9}, {32, 24}};

esi::ReconstructorConfig any_config(FuzzedDataProvider& data) {
  esi::ReconstructorConfig config;
  config.method = data.PickValueInArray({esi::Method::esi, esi::Method::accumulator,
                                         esi::Method::complementary_filter, esi::Method::edi,
                                         esi::Method::fedi, esi::Method::htac});
  config.esi.order =
      data.PickValueInArray({esi::EsiOrder::add_then_decay, esi::EsiOrder::decay_then_add});
  config.esi.decay_power = data.ConsumeFloatingPointInRange(0.0, 21.0);
  config.esi.decay_at_picture = data.ConsumeBool();
  config.accumulator.decay =
      data.PickValueInArray({esi::AccumulatorDecay::none, esi::AccumulatorDecay::exponential,
                             esi::AccumulatorDecay::linear, esi::AccumulatorDecay::step});
  config.accumulator.synchronous_decay = data.ConsumeBool();
  config.complementary_filter.use_frames = config.esi_net.use_frames = data.ConsumeBool();
  config.complementary_filter.cutoff_hz = data.ConsumeFloatingPointInRange(-0.1, 1000.0);
  config.complementary_filter.filter = data.PickValueInArray(
      {esi::SpatialFilter::none, esi::SpatialFilter::gaussian, esi::SpatialFilter::bilateral});
  config.edi.history_s = config.fedi.history_s = data.ConsumeFloatingPointInRange(0.0, 60.0);
  config.edi.search_contrast = config.fedi.search_contrast = data.ConsumeBool();
  config.htac.decay_time_s = data.ConsumeFloatingPointInRange(0.0, 1000.0);
  return config;
}

/// Mostly a small step on from `last`, now and then anywhere within 146 years.
core::Time any_time(FuzzedDataProvider& data, core::Time last) {
  constexpr std::int64_t kMost = std::int64_t{1} << 52;
  if (data.ConsumeIntegralInRange(0, 31) == 0)
    return core::Time(data.ConsumeIntegralInRange(-kMost, kMost));
  return last + core::Time(data.ConsumeIntegralInRange(-2, 40000));
}

std::vector<core::Event> any_events(FuzzedDataProvider& data, core::Resolution size,
                                    core::Time& last) {
  std::vector<core::Event> events(data.ConsumeIntegralInRange<std::size_t>(0, 40));
  for (core::Event& e : events) {
    last = any_time(data, last);
    e = {last,
         data.ConsumeIntegralInRange<std::uint16_t>(0, static_cast<std::uint16_t>(size.width_px)),
         data.ConsumeIntegralInRange<std::uint16_t>(0, static_cast<std::uint16_t>(size.height_px)),
         data.ConsumeBool()};
  }
  return events;
}

core::ApsFrame any_frame(FuzzedDataProvider& data, core::Resolution size, core::Time last) {
  core::ApsFrame frame;
  frame.exposure_begin = any_time(data, last);
  frame.exposure_end = any_time(data, frame.exposure_begin);
  frame.bits = data.PickValueInArray({8, 10, 8, 10, 0, 16, -1});
  if (data.ConsumeIntegralInRange(0, 15) == 0) size.width_px += 1;
  frame.gray = core::Image<std::uint16_t>(size, data.ConsumeIntegralInRange<std::uint16_t>(0, 260));
  for (int i = 0; i < 8; ++i)
    frame.gray.pixels()[data.ConsumeIntegral<std::uint8_t>() % frame.gray.pixels().size()] =
        data.ConsumeIntegralInRange<std::uint16_t>(0, 1100);
  return frame;
}

void any_call(FuzzedDataProvider& data, esi::Reconstructor& method, core::Time& last) {
  core::Picture picture;
  switch (data.ConsumeIntegralInRange(0, 7)) {
    case 0: method.reset(last = any_time(data, last)); break;
    case 1: method.render(any_time(data, last), picture); break;
    case 2: method.add_frame(any_frame(data, method.size(), last)); break;
    case 3: {
      std::vector<esi::PackedEvent> packed(data.ConsumeIntegralInRange<std::size_t>(0, 40));
      for (esi::PackedEvent& e : packed)
        e = {esi::low_us(last) + data.ConsumeIntegral<std::uint16_t>(),
             data.ConsumeIntegralInRange<std::uint32_t>(0, 1600)};
      method.process(packed);
      break;
    }
    default: method.process(any_events(data, method.size(), last));
  }
}

template <class Call>
void may_refuse(Call call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    if (std::string_view(error.what()).find('\n') != std::string_view::npos) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  FuzzedDataProvider data(bytes, count);
  std::unique_ptr<esi::Reconstructor> method;
  const core::Resolution size = data.PickValueInArray(kSizes);
  may_refuse([&] { method = esi::make_reconstructor(any_config(data), size); });
  if (!method) return 0;
  core::Time last{};
  while (data.remaining_bytes() > 0) may_refuse([&] { any_call(data, *method, last); });

  constexpr core::Time kLate{(std::int64_t{1} << 53) + 1};  // later than any time above
  core::Picture picture, again;
  method->process(std::vector<core::Event>{{kLate, 0, 0, true}});
  method->render(kLate, picture);
  method->render(kLate, again);
  if (picture.gray.size() != size || picture.gray != again.gray) std::abort();
  return 0;
}
