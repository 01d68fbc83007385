#pragma once

#include <vector>

#include "core/config_check.h"

namespace nightjar::scenarios {

/// One tag of a board, printed upright: `x_m` towards the board's top and `y_m` to the left,
/// as tag axes point (docs/frames.md), from the board's origin to the tag's middle.
struct BoardTag {
  int id = 0;            ///< Of family 36h11.
  double size_m = 0.24;  ///< Side of the black square, without the white border.
  double x_m = 0;
  double y_m = 0;

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("id", id, 0, 586);
    v.field("size_m", size_m, 0.001, 10.0);
    v.field("x_m", x_m, -100.0, 100.0);
    v.field("y_m", y_m, -100.0, 100.0);
  }
};

/// Tags on one plane; by default the one that the scenarios' landing board carries.
struct TagBoardConfig {
  std::vector<BoardTag> tags = {BoardTag{}};

  template <class Visitor>
  void visit(Visitor& v) {
    v.list("tags", tags, 1, 587);
  }
};

}  // namespace nightjar::scenarios
