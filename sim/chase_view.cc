#include "sim/chase_view.h"

#include <GL/gl.h>
#include <mujoco/mujoco.h>

#include <algorithm>

namespace nightjar::sim {

ChaseView::ChaseView(const Scene& scene, core::Resolution size)
    : off_screen_(*scene.model(), size, GL_RGB8),
      view_(scene),
      rows_(static_cast<std::size_t>(size.pixels())) {}

void ChaseView::draw(Scene& scene, const std::array<double, 3>& look_at_m, double distance_m,
                     double azimuth_deg, double elevation_deg, core::Image<Rgb>& picture) {
  view_.look_at(scene, look_at_m, distance_m, azimuth_deg, elevation_deg);
  mjvScene geoms = view_.geoms();
  const OffScreen::Current current(off_screen_);
  off_screen_.render(geoms);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, size().width_px, size().height_px, GL_RGB, GL_UNSIGNED_BYTE, rows_.data());
  if (picture.size() != size()) picture = core::Image<Rgb>(size());
  for (int y = 0; y < size().height_px; ++y)
    std::copy_n(rows_.begin() + (size().height_px - 1 - y) * size().width_px, size().width_px,
                &picture(0, y));
}

}  // namespace nightjar::sim
