#include "sim/drawing_thread.h"

#include <exception>

namespace nightjar::sim {

DrawingThread::DrawingThread(Renderer& renderer, const Scene& scene, double white_lux,
                             CameraThread& camera)
    : renderer_(renderer),
      scene_(scene),
      white_lux_(white_lux),
      camera_(camera),
      worker_([this](const Job& job) { draw(job); }) {}

View& DrawingThread::next() {
  next_ = &waiting_ahead_([this]() -> Job& { return worker_.next(); });
  if (!next_->view) next_->view.emplace(scene_);
  return *next_->view;
}

void DrawingThread::draw(core::Time t, bool ends_packet) {
  next_->t = t;
  next_->ends_packet = ends_packet;
  worker_.start();
}

void DrawingThread::draw(const Job& job) {
  if (failed_) return;
  try {
    core::Image<float>& picture = waiting_([this]() -> auto& { return camera_.next(); });
    drawing_([&] { renderer_.draw(*job.view, white_lux_, picture); });
    camera_.expose(job.t, job.ends_packet);
  } catch (...) {
    failed_ = true;
    camera_.fail(std::current_exception());
  }
}

std::vector<core::StageTime> DrawingThread::stage_times() const {
  return {waiting_ahead_.time(), drawing_.time(), waiting_.time()};
}

}  // namespace nightjar::sim
