#pragma once

#include "core/image.h"

namespace nightjar::tracker {

/// Tag `id` of family 36h11 as libapriltag draws it, white border included: 10 x
/// 10 cells, the black square being the inner 8 x 8, each cell `cell_px` pixels
/// wide. Throws std::invalid_argument for an id outside the family.
core::Image<std::uint8_t> tag_image(int id, int cell_px);

}  // namespace nightjar::tracker
