#pragma once

#include <vector>

#include "core/event.h"
#include "scenarios/calibration_board.h"

namespace nightjar::scenarios {

/// At most `most` of the views, those that differ most in where the board is in the picture,
/// how large and how tilted, in their order; of views that hardly differ (a board held still)
/// one. `size` is the pictures'.
std::vector<BoardView> choose_views(const std::vector<BoardView>& views, core::Resolution size,
                                    std::size_t most);

}  // namespace nightjar::scenarios
