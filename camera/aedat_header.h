#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "camera/aedat2_imu.h"
#include "camera/byte_stream.h"
#include "core/event.h"

namespace nightjar::camera {

/// What the lines at the beginning of an AEDAT 2.0 or 3.1 file tell.
struct AedatHeader {
  std::string camera;
  core::Resolution size;
  ImuScale imu_scale;  ///< From the settings that jAER keeps in AEDAT 2.0.
};

/// Reads the lines that begin with '#': up to and with `end`, or while there are any where
/// `end` is empty. Camera and size come from "#Source N: NAME" (3.1), "# AEChip: NAME"
/// (2.0) or "#Sensor: NAME WxH", which we write ourselves since names do not always tell
/// the size. Throws std::invalid_argument "FILE: byte N: ..." for a header that does not
/// end within 16 MiB (jAER keeps all its settings there), for another format than RAW, a
/// sensor that neither header nor `size` tell, and one that differs from `size`.
AedatHeader read_aedat_header(ByteStream& stream, std::string_view end,
                              std::optional<core::Resolution> size);

}  // namespace nightjar::camera
