#include "sim/drawing_thread.h"

#include <utility>

namespace nightjar::sim {
namespace {

/// Takes out the last one.
template <class T>
T pop(std::vector<T>& all) {
  T last = std::move(all.back());
  all.pop_back();
  return last;
}

/// Takes out the first one.
template <class T>
T pop(std::deque<T>& all) {
  T first = std::move(all.front());
  all.pop_front();
  return first;
}

}  // namespace

DrawingThread::DrawingThread(const Scene& scene, Draw draw)
    : scene_(scene), draw_(std::move(draw)), thread_([this] { run(); }) {}

DrawingThread::~DrawingThread() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

View DrawingThread::blank_view() {
  {
    const std::lock_guard lock(mutex_);
    if (!used_views_.empty()) return pop(used_views_);
  }
  return View(scene_);
}

void DrawingThread::add(core::Time t, View view) {
  {
    const std::lock_guard lock(mutex_);
    jobs_.push_back({t, std::move(view)});
  }
  changed_.notify_all();
}

DrawingThread::Picture DrawingThread::take() {
  return waiting_for_pictures_([this] {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return error_ || !pictures_.empty(); });
    if (pictures_.empty()) std::rethrow_exception(error_);
    return pop(pictures_);
  });
}

void DrawingThread::give_back(Picture picture) {
  const std::lock_guard lock(mutex_);
  used_pictures_.push_back(std::move(picture));
}

void DrawingThread::run() try {
  std::unique_lock lock(mutex_);
  while (true) {
    waiting_for_views_(
        [&] { changed_.wait(lock, [this] { return stopping_ || !jobs_.empty(); }); });
    if (stopping_) return;
    Job job = pop(jobs_);
    Picture picture = used_pictures_.empty() ? Picture() : pop(used_pictures_);
    lock.unlock();
    picture.t = job.t;
    drawing_([&] { draw_(job.view, picture.luminance_lux); });
    lock.lock();
    used_views_.push_back(std::move(job.view));
    pictures_.push_back(std::move(picture));
    changed_.notify_all();
  }
} catch (...) {
  const std::lock_guard lock(mutex_);
  error_ = std::current_exception();
  changed_.notify_all();
}

std::vector<core::StageTime> DrawingThread::stage_times() const {
  return {waiting_for_pictures_.time(), drawing_.time(), waiting_for_views_.time()};
}

}  // namespace nightjar::sim
