#include "scenarios/calibration_board.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "core/config_check.h"
#include "scenarios/yaml_reader.h"
#include "tracker/tag_detector.h"
#include "tracker/tag_pose.h"

namespace nightjar::scenarios {
namespace {

constexpr std::size_t kLeastTags = 2;  // four corners hardly tell a tilt from noise

/// Corners brought to where the grey levels' gradients say they are (Förstner and Gülch 1987, as
/// OpenCV has it): the finder's own are off by some hundredths of a pixel in the same direction,
/// which a focal length feels. The window keeps clear of the neighbours along rows and columns.
void refine(const cv::Mat& gray, std::size_t columns, std::vector<cv::Point2f>& corners) {
  double nearest_px = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < corners.size(); ++i) {
    if (i % columns != 0) nearest_px = std::min(nearest_px, cv::norm(corners[i] - corners[i - 1]));
    if (i >= columns)
      nearest_px = std::min(nearest_px, cv::norm(corners[i] - corners[i - columns]));
  }
  const int half_px = std::clamp(static_cast<int>(0.35 * nearest_px), 2, 8);
  cv::cornerSubPix(gray, corners, {half_px, half_px}, {-1, -1},
                   {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 40, 1e-3});
}

class CheckerboardFinder : public BoardFinder {
 public:
  explicit CheckerboardFinder(const Checkerboard& board) : board_(board) {
    core::check_range("corners.columns", board.columns, 3, 50);
    core::check_range("corners.rows", board.rows, 3, 50);
    core::check_range("square_m", board.square_m, 1e-4, 10);
  }

  std::optional<BoardView> find(const core::Picture& picture) override {
    const cv::Mat gray(picture.gray.height(), picture.gray.width(), CV_8U,
                       const_cast<std::uint8_t*>(picture.gray.pixels().data()));
    std::vector<cv::Point2f> corners;
    if (!cv::findChessboardCornersSB(gray, {board_.columns, board_.rows}, corners,
                                     cv::CALIB_CB_NORMALIZE_IMAGE))
      return std::nullopt;
    refine(gray, static_cast<std::size_t>(board_.columns), corners);
    BoardView view;
    for (int i = 0; const cv::Point2f& corner : corners) {
      view.corner_m.emplace_back(board_.square_m * (i % board_.columns),
                                 board_.square_m * (i / board_.columns));
      view.corner_px.emplace_back(corner.x, corner.y);
      ++i;
    }
    return view;
  }

 private:
  Checkerboard board_;
};

class TagBoardFinder : public BoardFinder {
 public:
  TagBoardFinder(const TagBoardConfig& board, const tracker::DetectorConfig& detector)
      : detector_(detector) {
    core::check_config(board, "board");
    for (const BoardTag& tag : board.tags)
      if (!tags_.emplace(tag.id, tag).second)
        throw std::invalid_argument(fmt::format("board.tags: id = {} is there twice", tag.id));
  }

  std::optional<BoardView> find(const core::Picture& picture) override {
    BoardView view;
    std::map<int, int> seen;
    const auto detections = detector_.detect(picture);
    for (const core::TagDetection& detection : detections) ++seen[detection.id];
    for (const core::TagDetection& detection : detections) {
      const auto tag = tags_.find(detection.id);
      if (tag == tags_.end() || seen[detection.id] > 1) continue;  // which of two is it?
      const auto corners = tracker::tag_corners_m(tag->second.size_m);
      for (std::size_t i = 0; i < corners.size(); ++i) {
        view.corner_m.emplace_back(tag->second.x_m + corners[i].x(),
                                   tag->second.y_m + corners[i].y());
        view.corner_px.push_back(detection.corner_px[i]);
      }
    }
    if (view.corner_px.size() < 4 * std::min<std::size_t>(kLeastTags, tags_.size()))
      return std::nullopt;
    return view;
  }

 private:
  tracker::TagDetector detector_;
  std::map<int, BoardTag> tags_;
};

}  // namespace

std::unique_ptr<BoardFinder> make_checkerboard_finder(const Checkerboard& board) {
  return std::make_unique<CheckerboardFinder>(board);
}

std::unique_ptr<BoardFinder> make_tag_board_finder(const TagBoardConfig& board,
                                                   const tracker::DetectorConfig& detector) {
  return std::make_unique<TagBoardFinder>(board, detector);
}

TagBoardConfig read_tag_board(const std::filesystem::path& path) {
  TagBoardConfig board;
  read_yaml(read_scenario_text(path), shown_file(path.string()), board);
  return board;
}

}  // namespace nightjar::scenarios
