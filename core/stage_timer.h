#pragma once

#include <chrono>
#include <cstdint>
#include <utility>

namespace nightjar::core {

/// What one stage of the loop has cost so far. Wall time: on cores that others use too
/// it holds their share as well.
struct StageTime {
  const char* stage;
  const char* thread;  ///< The one it runs on.
  std::chrono::nanoseconds wall{};
  std::uint64_t calls = 0;
};

/// Adds up the time a stage takes, for a profile; no result depends on it.
class StageTimer {
 public:
  /// Names that outlive it.
  StageTimer(const char* stage, const char* thread) : time_{stage, thread} {}

  /// Does `work` and returns what it gives.
  template <class Work>
  decltype(auto) operator()(Work&& work) {
    struct Lap {
      StageTime& time;
      std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now();
      ~Lap() {
        time.wall += std::chrono::steady_clock::now() - begin;
        ++time.calls;
      }
    } lap{time_};
    return std::forward<Work>(work)();
  }

  const StageTime& time() const { return time_; }

 private:
  StageTime time_;
};

}  // namespace nightjar::core
