#include "esi/reconstructor.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/config_check.h"
#include "esi/best_instructions.h"
#include "esi/prefetch.h"

namespace nightjar::esi {
namespace {

constexpr core::Time kMostAge{Reconstructor::kMostAge_us};
/// Events checked at once, then taken: they are still in a near cache. Fewer at a time, and
/// the memory's streams would break off at each turn.
constexpr std::size_t kBlock = 4096;
/// Those that are packed on the way.
constexpr std::size_t kPackBlock = 1024;
/// Those taken one by one where something is unusual.
constexpr std::size_t kSingly = 64;

/// Differences of times within it do not overflow, nor what packed events, which tell the
/// lower 32 bits of their time alone, could ever add to it.
constexpr core::Time kFarthest{Reconstructor::kFarthest_us};

void check_time(const char* what, core::Time t) {
  if (t < -kFarthest || t > kFarthest)
    throw std::invalid_argument(std::string(what) + " at " + std::to_string(t.count()) +
                                " us, allowed " + std::to_string(-kFarthest.count()) + " to " +
                                std::to_string(kFarthest.count()) + " us");
}

[[noreturn]] void refuse(core::Time t, std::uint32_t x, std::uint32_t y, core::Time last,
                         core::Resolution size) {
  if (t < last)
    throw std::invalid_argument("event at " + std::to_string(t.count()) + " us, allowed from " +
                                std::to_string(last.count()) + " us on");
  throw std::invalid_argument("event at (" + std::to_string(x) + ", " + std::to_string(y) +
                              "), allowed (0, 0) to (" + std::to_string(size.width_px - 1) + ", " +
                              std::to_string(size.height_px - 1) + ")");
}

/// Those that any value has: found sooner than the greatest value.
unsigned any_bits(std::span<const std::uint16_t> values) {
  const std::uint16_t* value = values.data();
  const std::size_t count = values.size();
  std::uint16_t bits = 0;
  std::uint16_t* const found = &bits;
  with_best_instructions([=]() __attribute__((always_inline)) {
    std::uint16_t together = 0;
    for (std::size_t i = 0; i < count; ++i) together |= value[i];
    *found = together;
  });
  return bits;
}

void check_frame(const core::ApsFrame& frame, core::Resolution size, core::Time earliest_begin) {
  check_time("frame", frame.exposure_begin);
  check_time("frame", frame.exposure_end);
  if (frame.gray.size() != size)
    throw std::invalid_argument("frame of " + std::to_string(frame.gray.width()) + "x" +
                                std::to_string(frame.gray.height()) + ", allowed " +
                                std::to_string(size.width_px) + "x" +
                                std::to_string(size.height_px));
  if (frame.exposure_end <= frame.exposure_begin)
    throw std::invalid_argument(
        "frame exposed from " + std::to_string(frame.exposure_begin.count()) + " to " +
        std::to_string(frame.exposure_end.count()) + " us, allowed to end after it begins");
  if (frame.exposure_begin < earliest_begin)
    throw std::invalid_argument(
        "frame exposed from " + std::to_string(frame.exposure_begin.count()) +
        " us, allowed from " + std::to_string(earliest_begin.count()) + " us on");
  if (frame.bits != 8 && frame.bits != 10)
    throw std::invalid_argument("frame of " + std::to_string(frame.bits) +
                                " bits, allowed 8 or 10");
  const auto pixels = frame.gray.pixels();
  if (any_bits(pixels) >> frame.bits != 0)
    throw std::invalid_argument("frame value " + std::to_string(std::ranges::max(pixels)) +
                                ", allowed 0 to " + std::to_string((1 << frame.bits) - 1));
}

}  // namespace

Reconstructor::Reconstructor(core::Resolution size) : size_(size) {
  core::check_range("sensor.width_px", size.width_px, 1, core::kMostSide_px);
  core::check_range("sensor.height_px", size.height_px, 1, core::kMostSide_px);
}

void Reconstructor::reset(core::Time start) {
  check_time("start", start);
  last_ = limited_ = start;
  frame_begin_ = core::Time::min();
  clear(start);
}

void Reconstructor::process(std::span<const core::Event> events) {
  for (; !events.empty(); events = events.subspan(std::min(events.size(), kPackBlock)))
    take_block(events.first(std::min(events.size(), kPackBlock)));
}

void Reconstructor::process(std::span<const PackedEvent> events) {
  const auto end = 2u * static_cast<std::uint32_t>(size_.pixels());
  while (!events.empty()) {
    const core::Time most = std::max(kMostAge - (last_ - limited_), core::Time{});
    EventRun run(events, low_us(last_), low_us(most), end);
    integrate_run(run);
    const std::size_t taken = events.size() - run.rest().size();
    if (taken > 0) last_ += core::Time(events[taken - 1].t_us - low_us(last_));
    events = run.rest();
    const std::size_t singly = std::min(events.size(), kSingly);
    take_singly(events.first(singly));
    events = events.subspan(singly);
  }
}

void Reconstructor::integrate_run(EventRun& run) {
  for (auto block = run.next(kBlock); !block.empty(); block = run.next(kBlock)) integrate(block);
}

void Reconstructor::take_block(std::span<const core::Event> events) {
  std::array<PackedEvent, kPackBlock> packed;
  core::Time earliest = last_;
  bool bad = false;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const core::Event& e = events[i];
    prefetch_ahead(&e);
    packed[i] = pack(e, size_.width_px);
    bad |= e.t < earliest || e.x >= size_.width_px || e.y >= size_.height_px;
    earliest = e.t;
  }
  if (!bad && events.back().t <= kFarthest && events.back().t - limited_ < kMostAge) {
    integrate(std::span(packed).first(events.size()));
    last_ = events.back().t;
    return;
  }
  for (std::size_t i = 0; i < events.size(); ++i) {
    const core::Event& e = events[i];
    if (e.t < last_ || e.x >= size_.width_px || e.y >= size_.height_px)
      refuse(e.t, e.x, e.y, last_, size_);
    check_time("event", e.t);
    take_one(e.t, packed[i]);
  }
}

void Reconstructor::take_singly(std::span<const PackedEvent> events) {
  const auto end = 2u * static_cast<std::uint32_t>(size_.pixels());
  const auto width = static_cast<std::uint32_t>(size_.width_px);
  for (const PackedEvent& e : events) {
    const core::Time t = last_ + core::Time(static_cast<std::int32_t>(e.t_us - low_us(last_)));
    if (t < last_ || e.pixel_on >= end)
      refuse(t, e.pixel() % width, e.pixel() / width, last_, size_);
    take_one(t, e);
  }
}

void Reconstructor::take_one(core::Time t, PackedEvent event) {
  advance_to(t);
  integrate({&event, 1});
  last_ = t;
}

void Reconstructor::advance_to(core::Time t) {
  if (t - last_ > kMostAge) {  // all is older than that, some perhaps by more than 32 bits hold
    limit_ages(low_us(t - kMostAge), 0);
    limited_ = t;
  } else if (t - limited_ >= kMostAge) {
    limit_ages(low_us(t), kMostAge_us);
    limited_ = t;
  }
}

void Reconstructor::add_frame(core::ApsFrame frame) {
  check_frame(frame, size_, frame_begin_);
  const core::Time begin = frame.exposure_begin;
  take_frame(std::move(frame));
  frame_begin_ = begin;
}

void Reconstructor::render(core::Time t, core::Picture& picture) {
  if (t < last_)
    throw std::invalid_argument("picture at " + std::to_string(t.count()) + " us, allowed from " +
                                std::to_string(last_.count()) + " us on");
  check_time("picture", t);
  picture.t = t;
  if (picture.gray.size() != size_) picture.gray = core::Image<std::uint8_t>(size_);
  draw(std::min(t, last_ + kMostAge), picture.gray);
}

}  // namespace nightjar::esi
