#include "tracker/tag_image.h"

#include <fmt/format.h>

#include <memory>
#include <stdexcept>

extern "C" {
#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
}

namespace nightjar::tracker {

core::Image<std::uint8_t> tag_image(int id, int cell_px) {
  const std::unique_ptr<apriltag_family_t, decltype(&tag36h11_destroy)> family(tag36h11_create(),
                                                                               tag36h11_destroy);
  const int count = static_cast<int>(family->ncodes);
  if (id < 0 || id >= count)
    throw std::invalid_argument(fmt::format("id = {}, allowed 0 to {}", id, count - 1));
  if (cell_px < 1) throw std::invalid_argument(fmt::format("cell_px = {}, at least 1", cell_px));

  const std::unique_ptr<image_u8_t, decltype(&image_u8_destroy)> cells(
      apriltag_to_image(family.get(), static_cast<uint32_t>(id)), image_u8_destroy);
  core::Image<std::uint8_t> image({cells->width * cell_px, cells->height * cell_px});
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      image(x, y) = cells->buf[(y / cell_px) * cells->stride + x / cell_px];
  return image;
}

}  // namespace nightjar::tracker
