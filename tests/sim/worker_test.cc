#include "sim/worker.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <numeric>
#include <thread>
#include <vector>

namespace nightjar::sim {
namespace {

TEST(Worker, does_every_job_once_and_in_order) {
  std::vector<int> done;
  std::atomic<std::size_t> count = 0;
  Worker<int, 3> worker([&](const int& job) {
    done.push_back(job);
    ++count;
  });
  for (int i = 0; i < 100; ++i) {
    worker.next() = i;
    worker.start();
  }
  while (count < 100) std::this_thread::yield();
  std::vector<int> expected(100);
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_EQ(done, expected);
}

TEST(Worker, gives_no_job_to_prepare_that_is_still_to_be_done) {
  std::atomic<int> begun = 0;
  std::atomic<bool> may_go_on = false;
  Worker<int, 2> worker([&](const int&) {
    ++begun;
    while (!may_go_on) std::this_thread::yield();
  });
  int* const first = &worker.next();
  worker.start();
  while (begun == 0) std::this_thread::yield();
  int* const second = &worker.next();
  EXPECT_NE(first, second);
  worker.start();
  may_go_on = true;
  EXPECT_EQ(&worker.next(), first);  // waits until it is done
}

TEST(Worker, leaves_what_was_not_begun) {
  std::atomic<int> begun = 0;
  std::atomic<bool> stopping = false;
  std::thread release;
  {
    Worker<int, 3> worker([&](const int&) {
      ++begun;
      while (!stopping) std::this_thread::yield();
    });
    for (int i = 0; i < 3; ++i) {
      worker.next();
      worker.start();
    }
    while (begun == 0) std::this_thread::yield();
    release = std::thread([&] {  // once the destructor below is at work
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      stopping = true;
    });
  }
  release.join();
  EXPECT_EQ(begun, 1);
}

}  // namespace
}  // namespace nightjar::sim
