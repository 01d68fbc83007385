#pragma once

#include <cstdint>
#include <optional>

#include "camera/recording.h"

namespace nightjar::camera {

/// One analogue read of an active pixel: right after its reset, or after its exposure.
struct ApsRead {
  core::Time t{};  ///< When the readout of its column began.
  int x = 0;
  int y = 0;
  bool signal = false;      ///< Else the reset level.
  std::uint16_t level = 0;  ///< 10 bits; falls as light is gathered.
};

/// Makes frames of single reads, as AEDAT 2.0 has them: a pixel's level is its reset read
/// minus its signal read (correlated double sampling), 0 where that is negative. Any order
/// of pixels will do, and resets may still come while the first signals do (a rolling
/// shutter).
///
/// A frame is complete when each pixel of the sensor has both reads. One of fewer pixels is
/// over when a pixel is reset again, or at finish(): it is a region of interest if its pixels
/// fill a rectangle, and has lost reads otherwise. One that had a signal read without its reset
/// has lost that, and is over as soon as a reset follows when all others have their signals: so
/// what the next frame has of the missing pixels is not taken for this one's.
///
/// The exposure ends with the first signal read; it begins with the last reset read, as in a
/// global shutter, or where signals came before that (a rolling shutter) with the first:
/// iniVation, AEDAT 2.0, which has the shutter told by the settings.
class ApsAssembler {
 public:
  explicit ApsAssembler(core::Resolution size);

  /// The frame that this read completes, or that is over with it. A read outside the sensor
  /// is a mistake of the caller's.
  std::optional<RecordedFrame> add(const ApsRead& read);

  /// The frame at hand at the end of the file, if there is one.
  std::optional<RecordedFrame> finish();

  core::Resolution size() const { return size_; }

  /// Frames that had lost reads, and signal reads that no reset came before.
  std::uint64_t frames_lost() const { return frames_lost_; }
  std::uint64_t signals_without_reset() const { return signals_without_reset_; }

 private:
  void add_reset(const ApsRead& read);
  void add_signal(const ApsRead& read);
  std::optional<RecordedFrame> take_frame();
  RecordedFrame cut_out() const;

  core::Resolution size_;
  core::Image<std::uint16_t> level_;  ///< The reset read, and then the difference.
  /// Twice the number of the frame that a pixel has its reset read of, one more when it has
  /// both: so nothing is to be cleared between frames.
  core::Image<std::uint32_t> stamp_;
  std::uint32_t frame_ = 1;
  int left_ = 0, top_ = 0, right_ = 0, bottom_ = 0;  ///< Around the pixels with both.
  int resets_ = 0, signals_ = 0;                     ///< Of the frame at hand.
  core::Time first_reset_{}, last_reset_{}, first_signal_{}, last_signal_{};
  bool rolling_ = false;
  bool astray_ = false;  ///< The frame at hand had a signal without its reset.
  std::uint64_t frames_lost_ = 0;
  std::uint64_t signals_without_reset_ = 0;
};

}  // namespace nightjar::camera
