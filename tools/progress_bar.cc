#include "tools/progress_bar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <utility>

namespace nightjar::tools {
namespace {

constexpr auto kBetweenDrawings = std::chrono::milliseconds(100);
constexpr const char* kClearLine = "\r\033[K";

std::string bar(double share) {
  constexpr int kWidth = 30;
  const int full = static_cast<int>(share * kWidth);
  return std::string(full, '#') + std::string(kWidth - full, '.');
}

}  // namespace

ProgressBar::ProgressBar(std::ostream& out, bool is_terminal, Clock clock)
    : out_(out),
      is_terminal_(is_terminal),
      clock_(std::move(clock)),
      start_(clock_()),
      last_drawn_(start_ - kBetweenDrawings) {}

ProgressBar::~ProgressBar() {
  if (drawn_ && is_terminal_) out_ << kClearLine << std::flush;
}

void ProgressBar::update(double done_s, double end_s, const std::string& phase) {
  const double share = end_s > 0 ? std::clamp(done_s / end_s, 0.0, 1.0) : 1.0;
  if (is_due(share))
    draw(share,
         fmt::format("{:.1f} of {:.1f} s  {} left  {}", done_s, end_s, remaining(share), phase));
}

void ProgressBar::update(double share, const std::string& phase) {
  if (is_due(share)) draw(share, fmt::format("{} left  {}", remaining(share), phase));
}

bool ProgressBar::is_due(double share) {
  if (is_terminal_) {
    const auto now = clock_();
    if (now - last_drawn_ < kBetweenDrawings) return false;
    last_drawn_ = now;
    return true;
  }
  constexpr double kRounding = 1e-9;  // 0.3 / 1.0 * 10 stays just below 3
  const int tenths = static_cast<int>(std::floor(share * 10 + kRounding));
  if (tenths <= tenths_written_) return false;
  tenths_written_ = tenths;
  return true;
}

std::string ProgressBar::remaining(double share) const {
  constexpr double kTooEarlyToTell = 0.005;
  if (share < kTooEarlyToTell) return "--:--";
  const double elapsed_s = std::chrono::duration<double>(clock_() - start_).count();
  const auto left_s = std::llround(elapsed_s * (1 - share) / share);
  return fmt::format("{}:{:02}", left_s / 60, left_s % 60);
}

void ProgressBar::draw(double share, const std::string& what) {
  const std::string line = fmt::format("{:3.0f} %  {}", std::floor(share * 100), what);
  if (is_terminal_)
    out_ << kClearLine << '[' << bar(share) << "] " << line;
  else
    out_ << line << '\n';
  out_ << std::flush;
  drawn_ = true;
}

}  // namespace nightjar::tools
