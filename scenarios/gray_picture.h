#pragma once

#include <filesystem>

#include "core/image.h"

namespace nightjar::scenarios {

/// Any picture OpenCV reads, as 8-bit grey. Throws std::invalid_argument, naming the file,
/// where it is none.
core::Image<std::uint8_t> read_gray_picture(const std::filesystem::path& path);

/// Writes a PNG, which has its name once it is complete: see core::PartFile for errors.
void write_png(const std::filesystem::path& path, const core::Image<std::uint8_t>& gray);

}  // namespace nightjar::scenarios
