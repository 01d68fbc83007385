#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/event.h"

namespace nightjar::camera {

/// What the camera's driver hands over at once. Each packet begins with its header, as
/// decode_caer_packet() takes it.
struct CaerContainer {
  std::vector<std::span<const std::byte>> packets;  ///< Valid until the next read().
  std::uint64_t lost_before = 0;  ///< Containers dropped between the one before and this.
};

/// What an opened camera says of itself.
struct CaerDeviceInfo {
  std::string serial;
  int chip = 0;  ///< One of caer::kChip...
  core::Resolution size;
  bool has_pixel_filter = false;
  bool has_background_activity_filter = false;  ///< And that of the refractory period.
};

/// The calls that a camera takes, and no logic: what stands behind it is libcaer or, in
/// tests, a double. An object is an open camera, to which libcaer's default settings were
/// sent; destroying it stops and closes the camera. All calls come from one thread but
/// for interrupt().
class CaerDevice {
 public:
  virtual ~CaerDevice() = default;

  virtual CaerDeviceInfo info() const = 0;

  /// Sets a parameter (caer_addresses.h). False when the camera refuses or is gone.
  virtual bool set(std::int8_t module, std::uint8_t parameter, std::uint32_t value) = 0;

  /// Sets a parameter of the software filter, which every polarity packet passes.
  virtual bool set_noise_filter(std::uint8_t parameter, std::uint64_t value) = 0;

  /// Data begin to flow; also turns on the IMU and the frames. False when they do not.
  virtual bool start() = 0;

  /// Waits for the next container, a second or so. False when none came in time, after
  /// interrupt(), and once a camera that went away has none left.
  virtual bool read(CaerContainer& container) = 0;

  /// Whether the camera is still there.
  virtual bool connected() const = 0;

  /// Makes read() return within milliseconds, now and from here on. From any thread.
  virtual void interrupt() = 0;
};

/// Opens the camera with a serial number, or the first found if it is empty. Throws
/// std::invalid_argument, saying what to do about it, when there is none.
using CaerOpener = std::function<std::unique_ptr<CaerDevice>(const std::string& serial)>;

/// libcaer's. Where Nightjar was built without it, throws and says how to get it.
std::unique_ptr<CaerDevice> open_caer_device(const std::string& serial);

}  // namespace nightjar::camera
