#include "scenarios/reconstruction_speed.h"

#include <algorithm>
#include <ctime>
#include <utility>

#include "esi/esi_reference.h"
#include "esi/leaky_sum.h"
#include "esi/make_network.h"
#include "scenarios/choice_text.h"
#include "scenarios/method_needs.h"

namespace nightjar::scenarios {
namespace {

/// CPU time of this thread: what others do on the machine counts less.
double cpu_s() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

class MethodSubject : public SpeedSubject {
 public:
  MethodSubject(const esi::ReconstructorConfig& config, core::Resolution size)
      : reconstructor_(esi::make_any_reconstructor(config, size)),
        uses_frames_(is_given_frames(config)) {}

  void restart() override { reconstructor_->reset(); }
  void take(std::span<const esi::PackedEvent> events) override { reconstructor_->process(events); }
  void draw(core::Time t) override { reconstructor_->render(t, picture_); }
  bool takes_frames() const override { return uses_frames_; }
  void take_frame(core::ApsFrame frame) override { reconstructor_->add_frame(std::move(frame)); }

 protected:
  std::unique_ptr<esi::Reconstructor> reconstructor_;

 private:
  bool uses_frames_;
  core::Picture picture_;
};

class UnpackedSubject final : public MethodSubject {
 public:
  UnpackedSubject(const esi::ReconstructorConfig& config, const EventWorkload& workload)
      : MethodSubject(config, workload.size), packed_(workload.events) {
    const auto width = static_cast<std::uint32_t>(workload.size.width_px);
    events_.reserve(packed_.size());
    for (const esi::PackedEvent& e : packed_)
      events_.push_back({core::Time(e.t_us), static_cast<std::uint16_t>(e.pixel() % width),
                         static_cast<std::uint16_t>(e.pixel() / width), e.on()});
  }

  void take(std::span<const esi::PackedEvent> events) override {
    const auto begin = static_cast<std::size_t>(events.data() - packed_.data());
    reconstructor_->process(std::span(events_).subspan(begin, events.size()));
  }

 private:
  std::span<const esi::PackedEvent> packed_;
  std::vector<core::Event> events_;
};

class ReferenceSubject final : public SpeedSubject {
 public:
  ReferenceSubject(const esi::EsiConfig& config, core::Resolution size)
      : config_(config), reference_(config, size), size_(size) {}

  void restart() override { reference_ = esi::EsiReference(config_, size_); }
  void take(std::span<const esi::PackedEvent> events) override { reference_.process(events); }
  void draw(core::Time t) override { gray_ = reference_.picture(t); }

 private:
  esi::EsiConfig config_;
  esi::EsiReference reference_;
  core::Resolution size_;
  core::Image<std::uint8_t> gray_;
};

class BoundSubject final : public SpeedSubject {
 public:
  explicit BoundSubject(core::Resolution size) : cells_(static_cast<std::size_t>(size.pixels())) {}

  void restart() override { std::ranges::fill(cells_, esi::SumCell{}); }
  void take(std::span<const esi::PackedEvent> events) override {
    for (const esi::PackedEvent& e : events) cells_[e.pixel()].t_us = e.t_us;
  }
  void draw(core::Time) override {}

 private:
  std::vector<esi::SumCell> cells_;
};

/// Hands over a workload piece by piece, each frame once the events up to its end are in.
class Walk {
 public:
  Walk(SpeedSubject& subject, const EventWorkload& workload)
      : subject_(subject), workload_(workload) {
    subject.restart();
    begin_s_ = cpu_s();
  }

  void take_until(std::size_t end, core::Time t) {
    subject_.take(std::span(workload_.events).subspan(taken_, end - taken_));
    taken_ = end;
    if (!subject_.takes_frames()) return;
    for (; frame_ < workload_.frames.size() && workload_.frames[frame_].exposure_end <= t; ++frame_)
      hand_over(workload_.frames[frame_]);
  }

  std::size_t taken() const { return taken_; }

  /// Since the beginning, but for the camera's part.
  double time_s() const { return cpu_s() - begin_s_ - camera_s_; }

 private:
  /// As a camera does, which has just written the frame: it is in the cache. The writing is not
  /// the subject's work.
  void hand_over(const core::ApsFrame& frame) {
    const double begin_s = cpu_s();
    core::ApsFrame written = frame;
    camera_s_ += cpu_s() - begin_s;
    subject_.take_frame(std::move(written));
  }

  SpeedSubject& subject_;
  const EventWorkload& workload_;
  double begin_s_ = 0, camera_s_ = 0;
  std::size_t taken_ = 0;
  std::size_t frame_ = 0;
};

struct Named {
  std::string name;
  std::unique_ptr<SpeedSubject> subject;
  bool shows = true;
};

Named named_method(esi::ReconstructorConfig config, esi::Method method, core::Resolution size) {
  config.method = method;
  return {choice_name(method, esi::kMethods), method_subject(config, size)};
}

std::vector<Named> all_subjects(const EventWorkload& workload, const SpeedOptions& options) {
  std::vector<Named> subjects;
  subjects.push_back(
      {"esi in doubles, std::pow", reference_subject(options.reconstructor.esi, workload.size)});
  for (const esi::Method method : options.methods) {
    subjects.push_back(named_method(options.reconstructor, method, workload.size));
    if (method != esi::Method::esi) continue;
    esi::ReconstructorConfig config = options.reconstructor;
    config.method = method;
    subjects.push_back({"esi, 16-byte events", unpacked_subject(config, workload)});
  }
  subjects.push_back({"bound", bound_subject(workload.size), false});
  return subjects;
}

/// 0 where the workload is too short for a picture.
double measure_picture_s(SpeedSubject& subject, const EventWorkload& workload, double rate_hz,
                         double most_s) {
  Walk walk(subject, workload);
  const core::Time period = core::from_seconds(1 / rate_hz);
  const core::Time last(workload.events.back().t_us);
  int pictures = 0;
  for (core::Time t = period; t <= last && walk.time_s() < most_s; t += period) {
    const auto rest = std::span(workload.events).subspan(walk.taken());
    const auto end = std::ranges::upper_bound(rest, esi::low_us(t), {}, &esi::PackedEvent::t_us);
    walk.take_until(walk.taken() + static_cast<std::size_t>(end - rest.begin()), t);
    subject.draw(t);
    ++pictures;
  }
  return pictures > 0 ? walk.time_s() / pictures : 0;
}

}  // namespace

std::unique_ptr<SpeedSubject> method_subject(const esi::ReconstructorConfig& config,
                                             core::Resolution size) {
  return std::make_unique<MethodSubject>(config, size);
}

std::unique_ptr<SpeedSubject> unpacked_subject(const esi::ReconstructorConfig& config,
                                               const EventWorkload& workload) {
  return std::make_unique<UnpackedSubject>(config, workload);
}

std::unique_ptr<SpeedSubject> reference_subject(const esi::EsiConfig& config,
                                                core::Resolution size) {
  return std::make_unique<ReferenceSubject>(config, size);
}

std::unique_ptr<SpeedSubject> bound_subject(core::Resolution size) {
  return std::make_unique<BoundSubject>(size);
}

double measure_rate_hz(SpeedSubject& subject, const EventWorkload& workload, bool pictures,
                       double most_s) {
  Walk walk(subject, workload);
  core::Time t{};
  constexpr std::size_t kBetweenLooks = 1'000'000;  // reading the clock takes time, too
  std::size_t next_look = kBetweenLooks;
  for (const std::size_t end : workload.packet_ends) {
    t += EventWorkload::kPacket;
    walk.take_until(end, t);
    if (pictures) subject.draw(t);
    if (!pictures && walk.taken() < next_look) continue;
    if (walk.time_s() >= most_s) break;
    next_look += kBetweenLooks;
  }
  return static_cast<double>(walk.taken()) / walk.time_s();
}

WorkloadSpeed measure_speed(const EventWorkload& workload, const SpeedOptions& options) {
  const std::vector<Named> subjects = all_subjects(workload, options);
  std::vector<std::vector<double>> events_hz(subjects.size()), with_pictures_hz(subjects.size());
  for (int round = 0; round < options.rounds; ++round)
    for (std::size_t i = 0; i < subjects.size(); ++i) {
      options.on_progress((round + static_cast<double>(i) / static_cast<double>(subjects.size())) /
                          options.rounds);
      SpeedSubject& subject = *subjects[i].subject;
      events_hz[i].push_back(measure_rate_hz(subject, workload, false, options.most_s));
      if (subjects[i].shows)
        with_pictures_hz[i].push_back(measure_rate_hz(subject, workload, true, options.most_s));
    }
  WorkloadSpeed speed{workload.name, workload.events.size(), {}};
  for (std::size_t i = 0; i < subjects.size(); ++i)
    speed.methods.push_back({subjects[i].name, median(events_hz[i]),
                             subjects[i].shows ? median(with_pictures_hz[i]) : 0});
  return speed;
}

std::vector<double> picture_rates_hz() { return {50, 100, 200, 500, 1000, 2000}; }

std::vector<MethodPictureTimes> measure_picture_times(const EventWorkload& workload,
                                                      const SpeedOptions& options) {
  std::vector<MethodPictureTimes> all;
  for (const esi::Method method : options.methods) {
    options.on_progress(static_cast<double>(all.size()) /
                        static_cast<double>(options.methods.size()));
    const Named named = named_method(options.reconstructor, method, workload.size);
    MethodPictureTimes times{named.name, {}};
    for (const double rate_hz : picture_rates_hz()) {
      std::vector<double> rounds_s;
      for (int round = 0; round < options.rounds; ++round)
        rounds_s.push_back(measure_picture_s(*named.subject, workload, rate_hz, options.most_s));
      if (rounds_s.front() > 0) times.times.push_back({rate_hz, median(rounds_s)});
    }
    all.push_back(std::move(times));
  }
  return all;
}

}  // namespace nightjar::scenarios
