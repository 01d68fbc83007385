#pragma once

#include <array>
#include <string>

#include "core/config_check.h"

namespace nightjar::camera {

/// A bias current of the chip: eight coarse decades, 256 fine steps within one.
struct BiasConfig {
  int coarse = 0;
  int fine = 0;

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("coarse", coarse, 0, 7, {"libcaer 3.3.9", core::kPureNumber});
    v.field("fine", fine, 0, 255, {"libcaer 3.3.9", core::kPureNumber});
  }
};

/// Those of a DAVIS346 that shape its events. No source gives values for dim light.
struct BiasesConfig {
  BiasConfig diff{4, 39};   ///< The level that the thresholds are measured from.
  BiasConfig on{5, 255};    ///< Up: a higher ON threshold.
  BiasConfig off{4, 1};     ///< Down: a higher OFF threshold.
  BiasConfig pr{2, 58};     ///< Photoreceptor: up, and its bandwidth and noise rise.
  BiasConfig pr_sf{1, 16};  ///< Its source follower: the same.
  BiasConfig refr{4, 25};   ///< Up: a shorter refractory period.

  template <class Visitor>
  void visit(Visitor& v) {
    v.section("diff", diff);
    v.section("on", on);
    v.section("off", off);
    v.section("pr", pr);
    v.section("pr_sf", pr_sf);
    v.section("refr", refr);
  }
};

/// Filters in the camera's logic, where it has them.
struct HardwareFilterConfig {
  bool background_activity = true;      ///< Drops events that no neighbour supports.
  double background_activity_ms = 2.0;  ///< In steps of 0.25 ms.
  bool refractory_period = false;
  double refractory_period_ms = 0.25;  ///< In steps of 0.25 ms.
  /// Finds the noisiest pixels in the first second after the start and blocks up to eight
  /// of them: keep the camera still meanwhile.
  bool learn_hot_pixels = false;

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("background_activity", background_activity, {"libcaer 3.3.9"});
    v.field("background_activity_ms", background_activity_ms, 0.25, 1000.0, {"libcaer 3.3.9"});
    v.field("refractory_period", refractory_period, {"libcaer 3.3.9"});
    v.field("refractory_period_ms", refractory_period_ms, 0.25, 1000.0, {"libcaer 3.3.9"});
    v.field("learn_hot_pixels", learn_hot_pixels, {"libcaer 3.3.9"});
  }
};

/// libcaer's filters on this computer.
struct SoftwareFilterConfig {
  bool background_activity = false;
  double background_activity_ms = 2.0;
  bool refractory_period = false;
  double refractory_period_ms = 0.1;
  /// Finds the hot pixels right after the start and drops their events from then on: keep
  /// the camera still meanwhile.
  bool learn_hot_pixels = false;
  double hot_pixel_learning_s = 1.0;
  int hot_pixel_events = 10000;  ///< Of a pixel during the learning.

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("background_activity", background_activity, {"libcaer 3.3.9"});
    v.field("background_activity_ms", background_activity_ms, 0.001, 1000.0, {"libcaer 3.3.9"});
    v.field("refractory_period", refractory_period, {"libcaer 3.3.9"});
    v.field("refractory_period_ms", refractory_period_ms, 0.001, 1000.0, {"libcaer 3.3.9"});
    v.field("learn_hot_pixels", learn_hot_pixels, {"libcaer 3.3.9"});
    v.field("hot_pixel_learning_s", hot_pixel_learning_s, 0.001, 60.0, {"libcaer 3.3.9"});
    v.field("hot_pixel_events", hot_pixel_events, 1, 1000000, {"libcaer 3.3.9"});
  }
};

/// When the camera went away: pauses between the attempts to open it anew.
struct ReconnectConfig {
  double first_pause_ms = 100.0;  ///< Doubles with every attempt ...
  double most_pause_ms = 5000.0;  ///< ... up to this.

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("first_pause_ms", first_pause_ms, 1.0, 60000.0, {"assumption: a loose plug"});
    v.field("most_pause_ms", most_pause_ms, 1.0, 60000.0, {"assumption: a look at the cable"});
  }
};

/// A DAVIS346 on a USB port, through libcaer.
struct CaerConfig {
  std::string serial;              ///< Empty: the first camera found.
  double packet_interval_ms = 10;  ///< Between packets: 100 pictures/s.
  int buffer_packets = 64;         ///< That wait for a slow reader before any are lost.
  bool frames = true;              ///< Expose APS frames.
  double exposure_ms = 4.0;
  double frame_interval_ms = 40.0;
  bool imu = true;
  BiasesConfig biases;
  HardwareFilterConfig hardware_filter;
  SoftwareFilterConfig software_filter;
  ReconnectConfig reconnect;

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("serial", serial);
    v.field("packet_interval_ms", packet_interval_ms, 0.1, 100.0, {"libcaer 3.3.9; ESI paper"});
    v.field("buffer_packets", buffer_packets, 2, 4096, {"libcaer 3.3.9", "packets"});
    v.field("frames", frames);
    v.field("exposure_ms", exposure_ms, 0.001, 4194.0, {"libcaer 3.3.9"});
    v.field("frame_interval_ms", frame_interval_ms, 0.001, 8388.0, {"libcaer 3.3.9"});
    v.field("imu", imu);
    v.section("biases", biases);
    v.section("hardware_filter", hardware_filter);
    v.section("software_filter", software_filter);
    v.section("reconnect", reconnect);
  }
};

}  // namespace nightjar::camera
