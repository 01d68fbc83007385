#define GL_GLEXT_PROTOTYPES
#include "sim/off_screen.h"

#include <GL/gl.h>
#include <GL/glext.h>
#include <GL/osmesa.h>
#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <array>
#include <cstdlib>
#include <stdexcept>

namespace nightjar::sim {
namespace {

constexpr int kFontScale = 100;

OSMesaContext create_context() {
  // llvmpipe filters 8-bit textures in 8-bit arithmetic unless told otherwise, and
  // reads this before its first context.
  setenv("GALLIVM_PERF", "no_aos_sampling", 1);
  // Draws on the calling thread: the rest of the loop has use for the other core, and waiting
  // for llvmpipe's own threads costs more than they gain (docs/decisions/0002). Whoever sets
  // the variable decides for himself.
  setenv("LP_NUM_THREADS", "0", 0);
  const std::array<int, 5> attributes = {OSMESA_FORMAT, OSMESA_RGBA, OSMESA_DEPTH_BITS, 24, 0};
  OSMesaContext context = OSMesaCreateContextAttribs(attributes.data(), nullptr);
  if (context == nullptr) throw std::runtime_error("OSMesa gave no context to draw in");
  return context;
}

}  // namespace

/// A context with a window of one pixel, which nobody draws into.
class OffScreen::Context {
 public:
  ~Context() { OSMesaDestroyContext(context_); }

  void make_current() {
    if (OSMesaMakeCurrent(context_, window_.data(), GL_UNSIGNED_BYTE, 1, 1) != GL_TRUE)
      throw std::runtime_error("OSMesa cannot draw in this thread");
  }

  void release() { OSMesaMakeCurrent(nullptr, nullptr, 0, 0, 0); }

 private:
  OSMesaContext context_ = create_context();
  std::array<std::uint8_t, 4> window_{};
};

OffScreen::OffScreen(const mjModel& model, core::Resolution size, unsigned color_format)
    : size_(size), context_(std::make_unique<Context>()) {
  const Current current(*this);
  description_ = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  if (description_.find("llvmpipe") == std::string::npos)
    throw std::runtime_error(
        fmt::format("OSMesa draws with '{}', wanted llvmpipe: unset GALLIUM_DRIVER", description_));
  resources_ = std::make_unique<mjrContext>();
  mjr_defaultContext(resources_.get());
  mjr_makeContext(&model, resources_.get(), kFontScale);
  make_frame_buffer(color_format);
}

void OffScreen::make_frame_buffer(unsigned color_format) {
  own_frame_buffer_ = resources_->offFBO;
  glGenFramebuffers(1, &resources_->offFBO);
  glBindFramebuffer(GL_FRAMEBUFFER, resources_->offFBO);
  const auto add = [this](unsigned& buffer, unsigned format, unsigned attachment) {
    glGenRenderbuffers(1, &buffer);
    glBindRenderbuffer(GL_RENDERBUFFER, buffer);
    glRenderbufferStorage(GL_RENDERBUFFER, format, size_.width_px, size_.height_px);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, buffer);
  };
  add(color_, color_format, GL_COLOR_ATTACHMENT0);
  add(depth_, GL_DEPTH_COMPONENT24, GL_DEPTH_ATTACHMENT);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error(fmt::format("OSMesa cannot draw {}x{} px in format {:#x}",
                                         size_.width_px, size_.height_px, color_format));
  mjr_setBuffer(mjFB_OFFSCREEN, resources_.get());
}

OffScreen::~OffScreen() {
  const Current current(*this);  // what is freed is numbered by context
  glDeleteFramebuffers(1, &resources_->offFBO);
  glDeleteRenderbuffers(1, &color_);
  glDeleteRenderbuffers(1, &depth_);
  resources_->offFBO = own_frame_buffer_;
  mjr_freeContext(resources_.get());
}

OffScreen::Current::Current(OffScreen& off_screen) : off_screen_(off_screen) {
  off_screen_.context_->make_current();
}

OffScreen::Current::~Current() { off_screen_.context_->release(); }

void OffScreen::render(mjvScene& geoms) {
  mjr_render({0, 0, size_.width_px, size_.height_px}, &geoms, resources_.get());
}

}  // namespace nightjar::sim
