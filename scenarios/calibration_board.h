#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/image.h"
#include "scenarios/tag_board_config.h"
#include "tracker/config.h"

namespace nightjar::scenarios {

/// A board as one picture shows it: where its corners are printed (m, on its plane) and where
/// they are seen (pixel centres at whole numbers), in the same order.
struct BoardView {
  std::string picture;  ///< Which one, for people.
  std::vector<Eigen::Vector2d> corner_m;
  std::vector<Eigen::Vector2d> corner_px;
};

class BoardFinder {
 public:
  virtual ~BoardFinder() = default;

  /// Nothing where the board is not to be seen; BoardView::picture stays empty.
  virtual std::optional<BoardView> find(const core::Picture& picture) = 0;
};

/// A board of black and white squares.
struct Checkerboard {
  int columns = 9;  ///< Of inner corners, where four squares meet.
  int rows = 6;
  double square_m = 0.03;
};

/// Finds the board when all of its inner corners are in the picture. Throws
/// std::invalid_argument for less than 3 or more than 50 columns or rows, and for squares not
/// between 0.0001 and 10 m. Board axes: x along a row, y along a column.
std::unique_ptr<BoardFinder> make_checkerboard_finder(const Checkerboard& board);

/// Finds whichever of the board's tags are in the picture, by tracker::TagDetector, four corners
/// each; at least two tags where the board has so many. Throws std::invalid_argument for values out
/// of range and an id that is there twice.
std::unique_ptr<BoardFinder> make_tag_board_finder(const TagBoardConfig& board,
                                                   const tracker::DetectorConfig& detector);

/// Throws ScenarioError, naming file, line and column, for what is no board.
TagBoardConfig read_tag_board(const std::filesystem::path& path);

}  // namespace nightjar::scenarios
