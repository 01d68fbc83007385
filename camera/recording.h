#pragma once

#include <cstdint>
#include <filesystem>
#include <istream>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/event.h"
#include "core/image.h"
#include "core/imu.h"

namespace nightjar::camera {

/// A signal at one of the camera's other inputs, or a mark of its own.
struct Trigger {
  core::Time t{};
  int type = 0;  ///< libcaer's number of the special event.

  friend bool operator==(const Trigger&, const Trigger&) = default;
};

/// An APS frame as recorded. Its picture may be smaller than the sensor (a region of
/// interest) and have 16 bits where the file has them; colours come as grey, by
/// Rec. ITU-R BT.709.
struct RecordedFrame : core::ApsFrame {
  core::Time frame_begin{};  ///< From the reset before the exposure ...
  core::Time frame_end{};    ///< ... to the end of the readout; all four times may be one.
  int left_px = 0;           ///< Of the picture's top left pixel, on the sensor.
  int top_px = 0;
};

/// Camera axes and SI units: docs/recordings.md on what the files hold.
struct RecordedImu : core::ImuSample {
  float temperature_c = std::numeric_limits<float>::quiet_NaN();
};

/// Part of a recording: each list ordered by time (frames by the middle of their
/// exposure), and no older than the same list's end in the part before.
struct RecordingPart {
  std::vector<core::Event> events;
  std::vector<RecordedFrame> frames;
  std::vector<RecordedImu> imu;
  std::vector<Trigger> triggers;

  void clear();
  bool empty() const;
  /// The earliest time of any list; 0 where all are empty.
  core::Time first_time() const;
};

/// What could not be used as it stood; reading went on.
struct RecordingFaults {
  std::uint64_t bytes_lost = 0;        ///< Truncated or damaged.
  std::uint64_t packets_unknown = 0;   ///< Of a type we do not read, or a second stream.
  std::uint64_t packets_damaged = 0;   ///< With content that is not what it should be.
  std::uint64_t events_outside = 0;    ///< Beyond the sensor's size; frames too.
  std::uint64_t events_backwards = 0;  ///< Older than their predecessor; of all lists.
  std::uint64_t time_resets = 0;       ///< Where the camera's clock began anew.
  std::string first;                   ///< "FILE: byte N: ..." of the first, else empty.

  bool any() const { return !first.empty(); }
};

/// Reads a recording piece by piece: what is in memory does not grow with the file, and
/// no packet takes more than 64 MiB.
class RecordingReader {
 public:
  virtual ~RecordingReader() = default;

  /// "AEDAT4", "AEDAT 3.1", "AEDAT 2.0", "text" or "LCM log".
  virtual std::string format() const = 0;

  /// As the file calls it ("DAVIS346_00000002"); empty when it does not say.
  virtual std::string camera() const = 0;

  /// The sensor, from the file or as given to open_recording().
  virtual core::Resolution size() const = 0;

  /// The next part, replacing what `part` held; false at the end. Times are the recording's
  /// own, 64 bits, wraps undone; after a reset of the camera's clock they go on from the
  /// latest time before it. Throws std::invalid_argument "FILE: byte N: ..." (for text:
  /// "FILE:line: ...") for what cannot be read on from.
  virtual bool next(RecordingPart& part) = 0;

  /// Share of the file that has been read, 0 to 1.
  virtual double progress() const = 0;

  /// So far.
  virtual const RecordingFaults& faults() const = 0;

  /// What the file holds besides and a recording has no place for, by the name it has there,
  /// and how often so far: the other messages in the log of a flight.
  virtual std::map<std::string, std::uint64_t> others() const { return {}; }
};

/// Opens a recording; its content, not its name, tells the format: AEDAT4, AEDAT 3.1,
/// AEDAT 2.0 or the text of RPG and v2e. `size` is for formats that do not tell the
/// sensor's, and is checked against those that do; text without it is read through once
/// to find the smallest sensor that holds its events. Throws std::invalid_argument, naming
/// the file, when it cannot be read, is of no known format, or the sizes differ.
std::unique_ptr<RecordingReader> open_recording(
    const std::filesystem::path& path, std::optional<core::Resolution> size = std::nullopt);

/// As above, from a stream that can seek; `name` stands for the file in errors.
std::unique_ptr<RecordingReader> open_recording(
    std::unique_ptr<std::istream> in, const std::string& name,
    std::optional<core::Resolution> size = std::nullopt);

}  // namespace nightjar::camera
