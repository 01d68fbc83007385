#include "sim/camera_thread.h"

#include <utility>

namespace nightjar::sim {

CameraThread::CameraThread(SimulatedCamera& camera)
    : camera_(camera), worker_([this](const Picture& picture) { show(picture); }) {}

core::Image<float>& CameraThread::next() {
  next_ = &worker_.next();
  return next_->luminance_lux;
}

void CameraThread::expose(core::Time t, bool ends_packet) {
  next_->t = t;
  next_->ends_packet = ends_packet;
  worker_.start();
}

void CameraThread::fail(std::exception_ptr error) {
  {
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = std::move(error);
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

void CameraThread::show(const Picture& picture) {
  {
    const std::lock_guard lock(mutex_);
    if (error_) return;
  }
  try {
    camera_.expose(picture.t, picture.luminance_lux);
    if (!picture.ends_packet) return;
    CameraOutput output{camera_.take_packet(), camera_.take_frames()};
    const std::lock_guard lock(mutex_);
    outputs_.push_back(std::move(output));
    changed_.notify_all();
  } catch (...) {
    fail(std::current_exception());
  }
}

}  // namespace nightjar::sim
