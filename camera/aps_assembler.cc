#include "camera/aps_assembler.h"

#include <algorithm>
#include <utility>

namespace nightjar::camera {
namespace {

constexpr int kBits = 10;

}  // namespace

ApsAssembler::ApsAssembler(core::Resolution size) : size_(size) {}

std::optional<RecordedFrame> ApsAssembler::add(const ApsRead& read) {
  if (stamp_.empty()) {  // a recording without frames needs no memory for them
    level_ = core::Image<std::uint16_t>(size_);
    stamp_ = core::Image<std::uint32_t>(size_);
  }
  std::optional<RecordedFrame> over;
  if (!read.signal) {
    const bool again = stamp_(read.x, read.y) / 2 == frame_;
    const bool settled = astray_ && signals_ > 0 && signals_ == resets_;
    if (again || settled) over = take_frame();
    add_reset(read);
  } else if (stamp_(read.x, read.y) == 2 * frame_) {
    add_signal(read);
    if (signals_ == size_.pixels()) over = take_frame();
  } else {
    ++signals_without_reset_;
    astray_ = astray_ || resets_ > 0;  // else it is of a frame before the one at hand
  }
  return over;
}

void ApsAssembler::add_reset(const ApsRead& read) {
  if (resets_++ == 0) first_reset_ = read.t;
  last_reset_ = read.t;
  rolling_ = rolling_ || signals_ > 0;
  level_(read.x, read.y) = read.level;
  stamp_(read.x, read.y) = 2 * frame_;
}

void ApsAssembler::add_signal(const ApsRead& read) {
  if (signals_++ == 0) {
    first_signal_ = read.t;
    left_ = right_ = read.x;
    top_ = bottom_ = read.y;
  }
  last_signal_ = read.t;
  left_ = std::min(left_, read.x), right_ = std::max(right_, read.x);
  top_ = std::min(top_, read.y), bottom_ = std::max(bottom_, read.y);
  std::uint16_t& level = level_(read.x, read.y);
  level = static_cast<std::uint16_t>(std::max(0, level - read.level));
  stamp_(read.x, read.y) = 2 * frame_ + 1;
}

std::optional<RecordedFrame> ApsAssembler::finish() {
  return resets_ > 0 ? take_frame() : std::nullopt;
}

/// Ends the frame at hand.
std::optional<RecordedFrame> ApsAssembler::take_frame() {
  const core::Resolution around{right_ - left_ + 1, bottom_ - top_ + 1};
  std::optional<RecordedFrame> frame;
  if (!astray_ && signals_ > 0 && signals_ == resets_ && signals_ == around.pixels())
    frame = cut_out();
  else
    ++frames_lost_;
  ++frame_;
  resets_ = signals_ = 0;
  rolling_ = astray_ = false;
  return frame;
}

RecordedFrame ApsAssembler::cut_out() const {
  RecordedFrame frame;
  frame.frame_begin = first_reset_;
  frame.frame_end = last_signal_;
  frame.exposure_begin = rolling_ ? first_reset_ : last_reset_;
  frame.exposure_end = first_signal_;
  frame.left_px = left_;
  frame.top_px = top_;
  frame.bits = kBits;
  frame.gray = core::Image<std::uint16_t>({right_ - left_ + 1, bottom_ - top_ + 1});
  for (int y = top_; y <= bottom_; ++y)
    for (int x = left_; x <= right_; ++x) frame.gray(x - left_, y - top_) = level_(x, y);
  return frame;
}

}  // namespace nightjar::camera
