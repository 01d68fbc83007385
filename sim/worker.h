#pragma once

#include <array>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>

namespace nightjar::sim {

/// Does jobs in order on a thread of its own. One other thread prepares them: while one job is
/// done, and kJobs - 2 wait, the next is prepared. Jobs are kept and used again.
template <class Job, std::size_t kJobs>
class Worker {
 public:
  /// `work` must not throw.
  explicit Worker(std::function<void(Job&)> work)
      : work_(std::move(work)), thread_([this] { run(); }) {}

  /// Finishes the job that was begun and leaves the others.
  ~Worker() {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }

  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// The job to prepare next; waits while all of them are still to be done.
  Job& next() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return prepared_ - done_ < kJobs; });
    return jobs_[prepared_ % kJobs];
  }

  /// Hands over the job that next() gave.
  void start() {
    {
      const std::lock_guard lock(mutex_);
      ++prepared_;
    }
    changed_.notify_all();
  }

 private:
  void run() {
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [this] { return stopping_ || done_ < prepared_; });
      if (stopping_) return;
      Job& job = jobs_[done_ % kJobs];
      lock.unlock();
      work_(job);
      lock.lock();
      ++done_;
      changed_.notify_all();
    }
  }

  std::function<void(Job&)> work_;
  std::array<Job, kJobs> jobs_;
  std::size_t prepared_ = 0, done_ = 0;
  bool stopping_ = false;
  std::mutex mutex_;  ///< Of all from prepared_ on.
  std::condition_variable changed_;
  std::thread thread_;  // last: it uses the others
};

}  // namespace nightjar::sim
