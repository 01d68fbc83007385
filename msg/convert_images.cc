#include <fmt/format.h>

#include <algorithm>
#include <nightjar_lcm/aps_frame_t.hpp>
#include <nightjar_lcm/picture_t.hpp>

#include "msg/convert.h"
#include "msg/lcm_bytes.h"

namespace nightjar::msg {
namespace {

template <class T, class Lcm>
void put_image(const core::Image<T>& image, Lcm& message) {
  message.width_px = image.width();
  message.height_px = image.height();
  message.n = image.size().pixels();
  message.gray.assign(image.pixels().begin(), image.pixels().end());
}

template <class T, class Lcm>
core::Image<T> get_image(const Lcm& message) {
  if (message.width_px < 0 || message.height_px < 0 ||
      std::int64_t{message.width_px} * message.height_px != message.n)
    throw std::invalid_argument(fmt::format("{}: {} x {} px with {} values, wanted one a pixel",
                                            Lcm::getTypeName(), message.width_px, message.height_px,
                                            message.n));
  core::Image<T> image(core::Resolution{message.width_px, message.height_px});
  std::ranges::transform(message.gray, image.pixels().begin(),
                         [](auto gray) { return static_cast<T>(gray); });
  return image;
}

void check_frame(const core::ApsFrame& frame) {
  if (frame.bits != 8 && frame.bits != 10 && frame.bits != 16)
    throw std::invalid_argument(
        fmt::format("aps_frame_t: bits = {}, allowed 8, 10, 16", frame.bits));
  const int greatest = (1 << frame.bits) - 1;
  for (const std::uint16_t gray : frame.gray.pixels())
    if (gray > greatest)
      throw std::invalid_argument(
          fmt::format("aps_frame_t: gray = {}, allowed 0 to {}", gray, greatest));
}

}  // namespace

Bytes encode(const core::Picture& picture) {
  nightjar_lcm::picture_t message;
  message.time_us = to_us(picture.t);
  put_image(picture.gray, message);
  return to_bytes(message);
}

template <>
core::Picture decode(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kCountOffset = 8 + 8 + 4 + 4;  // fingerprint, time_us, size
  check_array_fits("picture_t", bytes, kCountOffset, 1);
  const auto message = from_bytes<nightjar_lcm::picture_t>(bytes);
  return {core::Time(message.time_us), get_image<std::uint8_t>(message)};
}

Bytes encode(const core::ApsFrame& frame) {
  check_frame(frame);
  nightjar_lcm::aps_frame_t message;
  message.time_us = to_us(frame.exposure_end);
  message.exposure_begin_us = to_us(frame.exposure_begin);
  message.bits = frame.bits;
  put_image(frame.gray, message);
  return to_bytes(message);
}

template <>
core::ApsFrame decode(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kCountOffset = 8 + 8 + 8 + 4 + 4 + 4;  // and exposure_begin_us, bits
  check_array_fits("aps_frame_t", bytes, kCountOffset, 2);
  const auto message = from_bytes<nightjar_lcm::aps_frame_t>(bytes);
  core::ApsFrame frame{core::Time(message.exposure_begin_us), core::Time(message.time_us),
                       message.bits, get_image<std::uint16_t>(message)};
  check_frame(frame);
  return frame;
}

}  // namespace nightjar::msg
