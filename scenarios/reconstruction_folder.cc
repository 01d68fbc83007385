#include "scenarios/reconstruction_folder.h"

#include <fmt/format.h>

#include <cmath>
#include <regex>
#include <system_error>
#include <utility>
#include <vector>

#include "scenarios/gray_picture.h"
#include "scenarios/output_folder.h"

namespace nightjar::scenarios {
namespace fs = std::filesystem;
namespace {

constexpr const char* kTimesFile = "times.csv";
constexpr const char* kTagsFile = "tags.csv";
constexpr const char* kPicturesFile = "pictures.mp4";

/// A file of an earlier result.
bool is_result(const std::string& name) {
  static const std::regex kPicture(R"(picture_\d{6,}\.png)");
  return name == kSummaryFile || name == kTimesFile || name == kTagsFile || name == kPicturesFile ||
         std::regex_match(name, kPicture);
}

}  // namespace

ReconstructionFolder::ReconstructionFolder(fs::path folder, const Options& options)
    : folder_(std::move(folder)), is_new_(create_output_folder(folder_)) {
  try {
    times_.emplace(folder_ / kTimesFile);  // says whether the folder can be written
    remove_results();
    times_->stream() << "picture,time_us\n";
    if (options.tags) {
      tags_.emplace(folder_ / kTagsFile);
      tags_->stream() << "time_us,id,hamming,decision_margin,corners_px\n";
    }
    if (options.video) video_.emplace(folder_ / kPicturesFile, options.size, options.rate_hz);
  } catch (...) {
    times_.reset();
    tags_.reset();
    std::error_code ignored;
    if (is_new_) fs::remove(folder_, ignored);
    throw;
  }
}

ReconstructionFolder::~ReconstructionFolder() {
  if (finished_) return;
  times_.reset();
  tags_.reset();
  video_.reset();
  remove_results();
  std::error_code ignored;
  if (is_new_) fs::remove(folder_, ignored);  // only where it is empty
}

void ReconstructionFolder::remove_results() const {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder_, ignored))
    if (is_result(entry.path().filename().string())) files.push_back(entry.path());
  fs::remove(folder_ / kSummaryFile, ignored);  // first: what is half removed is not whole
  for (const fs::path& file : files) fs::remove(file, ignored);
}

void ReconstructionFolder::add(const core::Picture& picture,
                               std::span<const core::TagDetection> tags) {
  ++pictures_;
  times_->stream() << fmt::format("{},{}\n", pictures_, picture.t.count());
  if (video_)
    video_->add(picture.gray);
  else
    write_png(folder_ / fmt::format("picture_{:06}.png", pictures_), picture.gray);
  if (tags_) add_tags(tags);
  times_->check();
}

void ReconstructionFolder::add_tags(std::span<const core::TagDetection> tags) {
  for (const core::TagDetection& tag : tags) {
    std::string corners;
    for (const Eigen::Vector2d& corner : tag.corner_px)
      corners += fmt::format("{}{:.3f} {:.3f}", corners.empty() ? "" : " ", corner.x(), corner.y());
    tags_->stream() << fmt::format("{},{},{},{:.3f},{}\n", tag.t.count(), tag.id, tag.hamming,
                                   tag.decision_margin, corners);
  }
  tags_->check();
}

void ReconstructionFolder::finish(const std::string& summary) {
  if (pictures_ == 0) video_.reset();
  if (video_) video_->finish();
  times_->finish();
  if (tags_) tags_->finish();
  core::PartFile file(folder_ / kSummaryFile);
  file.stream() << summary;
  file.finish();
  finished_ = true;
}

}  // namespace nightjar::scenarios
