#include "sim/camera_thread.h"

#include <optional>
#include <utility>

namespace nightjar::sim {

CameraThread::CameraThread(SimulatedCamera& camera) : camera_(camera), thread_([this] { run(); }) {}

CameraThread::~CameraThread() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

core::Image<float>& CameraThread::next() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return drawn_ - exposed_ < kPictures; });
  return pictures_[drawn_ % kPictures].luminance_lux;
}

void CameraThread::expose(core::Time t, bool ends_packet) {
  {
    const std::lock_guard lock(mutex_);
    pictures_[drawn_ % kPictures].t = t;
    pictures_[drawn_ % kPictures].ends_packet = ends_packet;
    ++drawn_;
  }
  changed_.notify_all();
}

CameraOutput CameraThread::take() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return error_ || !outputs_.empty(); });
  if (outputs_.empty()) std::rethrow_exception(error_);
  CameraOutput output = std::move(outputs_.front());
  outputs_.pop_front();
  return output;
}

void CameraThread::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stopping_ || exposed_ < drawn_; });
    if (stopping_) return;
    const Picture& picture = pictures_[exposed_ % kPictures];
    const bool failed = error_ != nullptr;
    lock.unlock();
    std::optional<CameraOutput> output;
    std::exception_ptr error;
    try {
      if (!failed) camera_.expose(picture.t, picture.luminance_lux);
      if (!failed && picture.ends_packet) output = {camera_.take_packet(), camera_.take_frames()};
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    if (output) outputs_.push_back(std::move(*output));
    if (error) error_ = error;
    ++exposed_;
    changed_.notify_all();
  }
}

}  // namespace nightjar::sim
