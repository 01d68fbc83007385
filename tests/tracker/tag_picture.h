#pragma once

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/camera_model.h"
#include "core/image.h"
#include "core/random.h"
#include "tracker/tag_image.h"

namespace nightjar::tracker {

/// The camera of these tests: about a DAVIS346 with a 6 mm lens.
inline core::CameraModel test_camera() {
  return {.size = {346, 260}, .fx_px = 297, .fy_px = 297, .cx_px = 172.5, .cy_px = 129.5};
}

/// A camera `height_m` above the tag, displaced, turned and tilted.
inline Eigen::Isometry3d pose_above(double height_m, double x_m, double y_m, double heading_rad,
                                    double tilt_x_rad = 0, double tilt_y_rad = 0) {
  Eigen::Matrix3d R_camera_level;  // camera looking down, picture's top to the level x
  R_camera_level << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(tilt_x_rad, Eigen::Vector3d::UnitX()) *
               Eigen::AngleAxisd(tilt_y_rad, Eigen::Vector3d::UnitY()) * R_camera_level *
               Eigen::AngleAxisd(heading_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() << x_m, y_m, height_m;
  return T;
}

/// The printed tag (36h11, 0.24 m black square, white border) at T_camera_tag on
/// a mid-gray ground, each pixel the mean of oversampling^2 samples of its area.
inline core::Picture tag_picture(const core::CameraModel& camera,
                                 const Eigen::Isometry3d& T_camera_tag, int id = 0,
                                 int oversampling = 8) {
  constexpr int kCell_px = 8;
  constexpr double kSize_m = 0.30;
  core::Image<std::uint8_t> texture = tag_image(id, kCell_px);
  const cv::Mat source(texture.height(), texture.width(), CV_8U, texture.pixels().data());

  const double step_m = kSize_m / texture.width();
  Eigen::Matrix3d tag_of_texture;                          // texture pixel -> (x, y, 1) in tag axes
  tag_of_texture << 0, -step_m, kSize_m / 2 - step_m / 2,  //
      -step_m, 0, kSize_m / 2 - step_m / 2,                //
      0, 0, 1;
  Eigen::Matrix3d plane;  // (x, y, 1) in tag axes -> camera axes
  plane << T_camera_tag.linear().leftCols<2>(), T_camera_tag.translation();
  Eigen::Matrix3d pixel;
  pixel << camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1;

  cv::Mat gray(camera.size.height_px, camera.size.width_px, CV_8U, cv::Scalar(128));
  cv::Rect part(0, 0, gray.cols, gray.rows);  // only what the tag covers
  Eigen::AlignedBox2d box;
  for (const double x_m : {-kSize_m / 2, kSize_m / 2})
    for (const double y_m : {-kSize_m / 2, kSize_m / 2})
      box.extend((pixel * plane * Eigen::Vector3d(x_m, y_m, 1)).hnormalized());
  part &= cv::Rect(static_cast<int>(box.min().x()) - 2, static_cast<int>(box.min().y()) - 2,
                   static_cast<int>(box.sizes().x()) + 5, static_cast<int>(box.sizes().y()) + 5);
  Eigen::Matrix3d fine;  // pixel -> sample of the part, both with centres at whole numbers
  const double shift = (oversampling - 1) / 2.0;
  fine << oversampling, 0, shift - oversampling * part.x,  //
      0, oversampling, shift - oversampling * part.y,      //
      0, 0, 1;
  const Eigen::Matrix3d H = fine * pixel * plane * tag_of_texture;
  cv::Mat warp(3, 3, CV_64F);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) warp.at<double>(r, c) = H(r, c);

  if (!part.empty()) {
    cv::Mat samples(part.size() * oversampling, CV_8U, cv::Scalar(128));
    cv::warpPerspective(source, samples, warp, samples.size(), cv::INTER_NEAREST,
                        cv::BORDER_TRANSPARENT);
    cv::resize(samples, gray(part), part.size(), 0, 0, cv::INTER_AREA);
  }

  core::Picture picture{.t = {}, .gray = core::Image<std::uint8_t>(camera.size)};
  std::copy(gray.begin<std::uint8_t>(), gray.end<std::uint8_t>(), picture.gray.pixels().begin());
  return picture;
}

/// What a camera with a lens sees of a scene that its pinhole() sees as `picture`; mid-gray
/// where that picture ends.
inline core::Picture through_lens(const core::CameraModel& camera, core::Picture picture) {
  cv::Mat x(camera.size.height_px, camera.size.width_px, CV_32F), y = x.clone(), seen;
  for (int row = 0; row < x.rows; ++row)
    for (int column = 0; column < x.cols; ++column) {
      const Eigen::Vector2d from = camera.undistorted({column, row});
      x.at<float>(row, column) = static_cast<float>(from.x());
      y.at<float>(row, column) = static_cast<float>(from.y());
    }
  const cv::Mat pinhole(x.rows, x.cols, CV_8U, picture.gray.pixels().data());
  cv::remap(pinhole, seen, x, y, cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar(128));
  std::copy(seen.begin<std::uint8_t>(), seen.end<std::uint8_t>(), picture.gray.pixels().begin());
  return picture;
}

/// Gray noise on every pixel, and a share of the pixels black or white.
inline void add_noise(core::Picture& picture, double sigma, double salt_pepper_share,
                      core::Random& random) {
  for (std::uint8_t& gray : picture.gray.pixels()) {
    const double value = gray + sigma * core::normal(random);
    gray = static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
    const double u = core::uniform01(random);
    if (u < salt_pepper_share) gray = u < salt_pepper_share / 2 ? 0 : 255;
  }
}

}  // namespace nightjar::tracker
