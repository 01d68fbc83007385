#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "esi/packed_event.h"
#include "esi/prefetch.h"

namespace nightjar::esi {

/// Packed events handed out block by block, each block checked only as it is taken: a method
/// that works block by block itself has the memory gone through once, not twice.
class EventRun {
 public:
  /// For Reconstructor: hands out blocks whose times do not run backwards, from `begin_us`
  /// on, do not wrap, and stay less than `most_us` after it, at pixels below the end.
  EventRun(std::span<const PackedEvent> events, std::uint32_t begin_us, std::uint32_t most_us,
           std::uint32_t pixel_on_end)
      : rest_(events), limits_{begin_us, begin_us, most_us, pixel_on_end} {}

  /// Hands out all, as they are: they have been checked.
  explicit EventRun(std::span<const PackedEvent> events) : rest_(events), checked_(true) {}

  /// The next events, as many as `most` or as there are; none at the end, and from the first
  /// block on that is not as it has to be.
  [[gnu::always_inline]] std::span<const PackedEvent> next(std::size_t most) {
    const auto block = rest_.first(std::min(rest_.size(), most));
    if (block.empty() || (!checked_ && !is_plain(block.data(), block.size()))) return {};
    take(block.size());
    return block;
  }

  /// What next() holds the events against.
  struct Limits {
    std::uint32_t earliest_us;  ///< Of the next event.
    std::uint32_t begin_us;
    std::uint32_t most_us;
    std::uint32_t pixel_on_end;
  };
  /// For a method that has a faster way than next() to see that the next few are as they have
  /// to be; null where they need not be checked.
  const Limits* limits() const { return checked_ ? nullptr : &limits_; }

  /// Counts the next `count`, at least one, as handed out.
  [[gnu::always_inline]] void take(std::size_t count) {
    constexpr std::size_t kLine = 64 / sizeof(PackedEvent);
    for (std::size_t i = 0; i < count; i += kLine) prefetch_ahead(&rest_[i]);
    limits_.earliest_us = rest_[count - 1].t_us;
    rest_ = rest_.subspan(count);
  }

  /// What has not been handed out.
  std::span<const PackedEvent> rest() const { return rest_; }

 private:
  /// Written to be vectorised: no early exit, and words, not bools, to gather in.
  [[gnu::always_inline]] bool is_plain(const PackedEvent* events, std::size_t count) const {
    const Limits& l = limits_;
    std::uint32_t bad = events[0].t_us < l.earliest_us || events[0].pixel_on >= l.pixel_on_end ||
                                events[count - 1].t_us - l.begin_us >= l.most_us
                            ? 1
                            : 0;
    for (std::size_t i = 1; i < count; ++i) {
      bad |= events[i].t_us < events[i - 1].t_us ? 1u : 0u;
      bad |= events[i].pixel_on >= l.pixel_on_end ? 1u : 0u;
    }
    return bad == 0;
  }

  std::span<const PackedEvent> rest_;
  Limits limits_{};
  bool checked_ = false;
};

}  // namespace nightjar::esi
