#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "core/event.h"
#include "core/image.h"

namespace nightjar::camera {

/// Frames that were taken or drawn elsewhere, one after the other.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// The next frame as linear intensity, 1 = white, all of one size; false after the
  /// last. Negative values come as 0; NaN, infinity and what is beyond +-1e20 come as NaN. Throws
  /// std::invalid_argument, naming the file, for a frame that cannot be read, is of
  /// another size than the first or of a kind that is not known.
  virtual bool next(core::Image<float>& intensity) = 0;

  /// Frames per second.
  virtual double rate_hz() const = 0;

  /// Frames there should be, or 0 where a video does not tell.
  virtual int announced_frames() const = 0;

  /// Pixels so far that were negative, NaN, infinite or beyond +-1e20.
  virtual std::uint64_t bad_values() const = 0;
};

struct FrameOptions {
  std::optional<double> rate_hz = {};         ///< Needed for pictures; a video has its own.
  std::optional<core::Resolution> size = {};  ///< Resized to, averaging over the area.
  double float_white = 1.0;                   ///< What is white in pictures of floats.
};

/// Opens a folder of pictures, in natural order of their names, or a video.
///
/// 8-bit and 16-bit codes are taken as linear intensity with white at 255 and 65535, as
/// v2e does; colours are weighed as by ITU-R BT.709. Alpha is left out.
///
/// Two of OpenCV's settings are environment variables, which whoever wants them sets
/// before other threads begin: OPENCV_IO_ENABLE_OPENEXR=1 where OpenCV was built without
/// (its releases; Debian's reads EXR anyway), before the first picture is read; and
/// OPENCV_FFMPEG_LOGLEVEL=-8 for an FFmpeg that does not print to stderr by itself.
///
/// Throws std::invalid_argument, naming what is wrong, for a path that is neither, a
/// folder that cannot be read or has fewer than two pictures or with several kinds of them, no
/// rate, and an option out of range (rate 0.001 to 1e6 Hz, size 1 to 32767 px, white above 0).
std::unique_ptr<FrameSource> open_frames(const std::filesystem::path& path,
                                         const FrameOptions& options);

}  // namespace nightjar::camera
