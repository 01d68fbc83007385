#include <fmt/format.h>

#include <algorithm>
#include <nightjar_lcm/aps_frame_t.hpp>
#include <nightjar_lcm/picture_t.hpp>

#include "msg/convert.h"
#include "msg/lcm_bytes.h"

namespace nightjar::msg {
namespace {

template <class Lcm>
void put_image(const core::Image<std::uint8_t>& image, Lcm& message) {
  message.width_px = image.width();
  message.height_px = image.height();
  message.n = image.size().pixels();
  message.gray.assign(image.pixels().begin(), image.pixels().end());
}

template <class Lcm>
core::Image<std::uint8_t> get_image(const Lcm& message) {
  if (message.width_px < 0 || message.height_px < 0 ||
      std::int64_t{message.width_px} * message.height_px != message.n)
    throw std::invalid_argument(fmt::format("{}: {} x {} px with {} bytes, wanted one a pixel",
                                            Lcm::getTypeName(), message.width_px, message.height_px,
                                            message.n));
  core::Image<std::uint8_t> image(core::Resolution{message.width_px, message.height_px});
  std::ranges::copy(message.gray, image.pixels().begin());
  return image;
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
  return {core::Time(message.time_us), get_image(message)};
}

Bytes encode(const core::ApsFrame& frame) {
  nightjar_lcm::aps_frame_t message;
  message.time_us = to_us(frame.exposure_end);
  message.exposure_begin_us = to_us(frame.exposure_begin);
  put_image(frame.gray, message);
  return to_bytes(message);
}

template <>
core::ApsFrame decode(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kCountOffset = 8 + 8 + 8 + 4 + 4;  // and exposure_begin_us
  check_array_fits("aps_frame_t", bytes, kCountOffset, 1);
  const auto message = from_bytes<nightjar_lcm::aps_frame_t>(bytes);
  return {core::Time(message.exposure_begin_us), core::Time(message.time_us), get_image(message)};
}

}  // namespace nightjar::msg
