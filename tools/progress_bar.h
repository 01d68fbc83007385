#pragma once

#include <chrono>
#include <functional>
#include <iosfwd>
#include <string>

namespace nightjar::tools {

/// How far a run is and how long it may still take. On a terminal one line is
/// drawn over and over, at most ten times a second; elsewhere a line is written
/// every 10 %.
class ProgressBar {
 public:
  using Clock = std::function<std::chrono::steady_clock::time_point()>;

  /// Draws to `out`, which has to outlive the bar.
  ProgressBar(std::ostream& out, bool is_terminal, Clock clock = std::chrono::steady_clock::now);

  /// Clears a drawn line, so that what follows starts on an empty one.
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// `done_s` of `end_s` simulated seconds are flown; `phase` names what happens.
  void update(double done_s, double end_s, const std::string& phase);

  /// The same for work that is not measured in seconds: `share` of it, 0 to 1, is done.
  void update(double share, const std::string& phase);

 private:
  bool is_due(double share);
  std::string remaining(double share) const;
  void draw(double share, const std::string& what);

  std::ostream& out_;
  bool is_terminal_;
  Clock clock_;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point last_drawn_;
  int tenths_written_ = 0;
  bool drawn_ = false;
};

}  // namespace nightjar::tools
