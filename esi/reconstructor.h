#pragma once

#include <cstdint>
#include <span>

#include "core/event.h"
#include "core/image.h"
#include "esi/event_run.h"
#include "esi/packed_event.h"

namespace nightjar::esi {

/// Turns events into 8-bit pictures, 0 black. The picture depends on the events and
/// frames, never on where the stream was cut into batches
/// (tests/esi/reconstructor_contract_test.cc holds every method to that).
///
/// This class checks what comes in and keeps the time; a method fills in the protected
/// part. What a call refuses leaves the object as if only the events before had come.
class Reconstructor {
 public:
  /// Pixels forget how long ago something was beyond this: 17.9 minutes.
  static constexpr std::uint32_t kMostAge_us = 1u << 30;

  /// Whole times (not those of packed events) further than this from 0 are refused by every
  /// call that is given one: 73,000 years.
  static constexpr std::int64_t kFarthest_us = std::int64_t{1} << 61;

  /// Throws std::invalid_argument for a side outside 1 to core::kMostSide_px.
  explicit Reconstructor(core::Resolution size);
  virtual ~Reconstructor() = default;
  Reconstructor(const Reconstructor&) = delete;
  Reconstructor& operator=(const Reconstructor&) = delete;

  core::Resolution size() const { return size_; }

  /// Takes the next events, ordered by time and none older than those before or than
  /// the start. Throws std::invalid_argument for an event outside the sensor or older
  /// than its predecessor; the events before it have then been taken.
  void process(std::span<const core::Event> events);

  /// The same from packed events, as fast as it gets. Each may be up to 35 minutes
  /// (2^31 us) later than its predecessor: further is taken as running backwards.
  void process(std::span<const PackedEvent> events);

  /// Takes a frame of the active pixels, for the methods that use them; the others only
  /// check it. Hand it over once the events up to its end have been taken: it acts from
  /// then on. Throws std::invalid_argument for another size than the sensor's, an
  /// exposure that does not end after it begins, bits other than 8 or 10, a value beyond
  /// them, or a frame that begins before its predecessor does. Moved in, it need not be copied.
  void add_frame(core::ApsFrame frame);

  /// The picture at `t`. Throws std::invalid_argument when `t` lies before the last event.
  /// Two calls with no event between give, for the same `t`, the same picture.
  void render(core::Time t, core::Picture& picture);

  /// Returns to the state after construction, as if nothing had happened at any pixel
  /// until `start`. Needed first where times do not begin near 0.
  void reset(core::Time start = core::Time{});

 protected:
  /// The events, in order and on the sensor. Virtual once per batch: the loop over
  /// events is inside each method.
  virtual void integrate(std::span<const PackedEvent> events) = 0;

  /// The same, block by block to the run's end: for a method that wants blocks checked only
  /// as it comes to them.
  virtual void integrate_run(EventRun& run);

  /// To keep, or to look at.
  virtual void take_frame(core::ApsFrame&&) {}

  /// Fills `gray`, which has the sensor's size. `t` is at most kMostAge_us after last().
  virtual void draw(core::Time t, core::Image<std::uint8_t>& gray) = 0;

  /// Back to the start. A method's constructor calls reset(), which calls this.
  virtual void clear(core::Time start) = 0;

  /// Makes every time kept that lies more than `most_us` before `now_us` lie just that
  /// far before it: limit_times() below. Keeps 32-bit differences unambiguous.
  virtual void limit_ages(std::uint32_t now_us, std::uint32_t most_us) = 0;

  /// The time of the last event taken, or the start.
  core::Time last() const { return last_; }

 private:
  void take_block(std::span<const core::Event> events);
  void take_singly(std::span<const PackedEvent> events);
  void take_one(core::Time t, PackedEvent event);
  void advance_to(core::Time t);

  core::Resolution size_;
  core::Time last_{};
  core::Time limited_{};  ///< When ages were last limited.
  core::Time frame_begin_ = core::Time::min();
};

/// limit_ages() for cells that keep their time in `t_us`.
template <class Cells>
void limit_times(Cells& cells, std::uint32_t now_us, std::uint32_t most_us) {
  for (auto& cell : cells)
    if (now_us - cell.t_us > most_us) cell.t_us = now_us - most_us;
}

}  // namespace nightjar::esi
