#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "esi/config.h"
#include "scenarios/event_workloads.h"

namespace nightjar::scenarios {

/// Something that takes a workload's events and shows pictures, and how fast.
class SpeedSubject {
 public:
  virtual ~SpeedSubject() = default;
  virtual void restart() = 0;
  virtual void take(std::span<const esi::PackedEvent> events) = 0;
  virtual void draw(core::Time t) = 0;

  /// Whether take_frame() does anything.
  virtual bool takes_frames() const { return false; }
  virtual void take_frame(core::ApsFrame) {}
};

/// A reconstructor, checks and all, handed packed events.
std::unique_ptr<SpeedSubject> method_subject(const esi::ReconstructorConfig& config,
                                             core::Resolution size);

/// The same, handed core::Event, for this workload alone: it is unpacked beforehand.
std::unique_ptr<SpeedSubject> unpacked_subject(const esi::ReconstructorConfig& config,
                                               const EventWorkload& workload);

/// ESI in doubles and std::pow, without checks: esi::EsiReference.
std::unique_ptr<SpeedSubject> reference_subject(const esi::EsiConfig& config,
                                                core::Resolution size);

/// What no method can do without: to read each event and touch its 8-byte cell. Shows
/// nothing.
std::unique_ptr<SpeedSubject> bound_subject(core::Resolution size);

/// Events a second, in CPU time of this thread, through a workload from its start packet by
/// packet, for about `most_s` or up to its end, whichever is first; with a picture after
/// every packet or without any. Taking frames counts, for the methods that use them; the others
/// would only check them, which is no work on events. A frame is handed over as a camera does it,
/// which has just written it: the writing is the camera's and does not count.
double measure_rate_hz(SpeedSubject& subject, const EventWorkload& workload, bool pictures,
                       double most_s);

/// One method's line in the table: medians of several rounds that took turns.
struct MethodSpeed {
  std::string method;
  double events_hz = 0;         ///< Events a second, no picture.
  double with_pictures_hz = 0;  ///< Events a second, a picture every 10 ms; 0 = shows none.
};

struct WorkloadSpeed {
  std::string workload;
  std::size_t events = 0;
  std::vector<MethodSpeed> methods;  ///< First the reference, last the bound.
};

/// How long a picture takes with the events since the one before.
struct PictureTime {
  double rate_hz = 0;  ///< Pictures a second of the recording's time.
  double time_s = 0;   ///< CPU time, mean.
};

struct MethodPictureTimes {
  std::string method;
  std::vector<PictureTime> times;  ///< By rate, rising; none slower than the workload is long.
};

struct SpeedOptions {
  esi::ReconstructorConfig reconstructor;  ///< Its method does not matter.
  std::vector<esi::Method> methods;
  int rounds = 3;
  double most_s = 0.03;  ///< For each method, workload and round.
  /// Called with what is done of one workload, 0 to 1; may throw to end it.
  std::function<void(double)> on_progress = [](double) {};
};

/// The speed of the reference, of each method and of the bound. Throws
/// std::invalid_argument where a method cannot be built.
WorkloadSpeed measure_speed(const EventWorkload& workload, const SpeedOptions& options);

/// The pictures a second that measure_picture_times() tries: 50 to 2000.
std::vector<double> picture_rates_hz();

/// Each method at each rate. Throws as measure_speed().
std::vector<MethodPictureTimes> measure_picture_times(const EventWorkload& workload,
                                                      const SpeedOptions& options);

}  // namespace nightjar::scenarios
