#include "scenarios/loop.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string_view>

#include "msg/bus.h"
#include "msg/log_writer.h"
#include "scenarios/estimates_csv.h"
#include "scenarios/flight_end.h"
#include "scenarios/output_folder.h"
#include "scenarios/reconstruction_node.h"
#include "scenarios/record_node.h"
#include "scenarios/scorer.h"
#include "scenarios/simulation_node.h"
#include "scenarios/source_check.h"
#include "scenarios/tracker_node.h"
#include "scenarios/video.h"
#include "sim/simulation.h"

namespace nightjar::scenarios {
namespace {

void record_channels(msg::LogWriter& log, msg::Bus& bus, bool events) {
  log.record(bus, msg::kTruth);
  log.record(bus, msg::kVehicleState);
  log.record(bus, msg::kApsFrame);
  log.record(bus, msg::kImu);
  if (events) log.record(bus, msg::kEvents);
  log.record(bus, msg::kPicture);
  log.record(bus, msg::kTagDetections);
  log.record(bus, msg::kTargetEstimate);
  log.record(bus, msg::kMissionTransition);
  log.record(bus, msg::kAttitudeSetpoint);
}

/// One flight: all modules on one bus, and what is written down about it.
class Run {
 public:
  Run(const Scenario& scenario, const RunOptions& options);

  void fly();
  Summary finish(double wall_time_s);

 private:
  void take(const PictureRecord& record);
  void handle();
  void film();
  void add_sensor_counts(Summary& summary) const;
  std::vector<core::StageTime> stage_times() const;

  const Scenario& scenario_;
  const RunOptions& options_;
  OutputFolder folder_;  // first: a run that cannot begin leaves no earlier one's results
  sim::Simulation simulation_;
  msg::Bus bus_;
  Scorer scorer_;
  EstimatesCsv csv_;
  msg::LogWriter log_;
  std::optional<Video> video_;
  SimulationNode world_;
  ReconstructionNode reconstruction_;
  TrackerNode tracker_;
  RecordNode records_;
  FlightEnd end_;
  core::StageTimer handling_{"all messages", "loop"};
  core::StageTimer filming_{"film", "loop"};
  core::MissionPhase phase_ = core::MissionPhase::search;
};

Scorer::Setup scorer_setup(const Scenario& scenario, const core::CameraModel& camera) {
  return {scenario.name, static_cast<std::uint64_t>(scenario.seed), camera, scenario.tag,
          scenario.pass};
}

Run::Run(const Scenario& scenario, const RunOptions& options)
    : scenario_(scenario),
      options_(options),
      folder_(options.out),
      simulation_(scenario.world, scenario.camera, scenario.sensor, scenario.model,
                  scenario.illuminance_lux, static_cast<std::uint64_t>(scenario.seed)),
      scorer_(scorer_setup(scenario, simulation_.world().camera_model())),
      csv_(folder_),
      log_(folder_.path(kLogFile)),
      world_(bus_, simulation_),
      reconstruction_(bus_, scenario.reconstructor, simulation_.world().camera_model().size),
      tracker_(bus_, scenario.tracker, simulation_.world().camera_model(),
               simulation_.world().T_body_camera()),
      records_(bus_, [this](const PictureRecord& record) { take(record); }),
      end_(bus_, scenario.duration_s) {
  spdlog::info("rendering with {}", simulation_.world().renderer_description());
  save(scenario, folder_.part(kScenarioFile));
  folder_.complete(kScenarioFile);
  record_channels(log_, bus_, options.record_events);
  if (options.record_events)  // then the log is a recording too
    log_.write(msg::kSensor.name, msg::encode(msg::SensorNote{
                                      {}, simulation_.world().camera_model().size, "Nightjar"}));
  bus_.subscribe(msg::kMissionTransition, [this](const core::MissionTransition& transition) {
    scorer_.add(transition);
    phase_ = transition.to;
    spdlog::info("{:7.2f} s  {} -> {}: {}", core::seconds(transition.t), to_string(transition.from),
                 to_string(transition.to), transition.cause);
  });
  if (options.video) video_.emplace(bus_, folder_, simulation_.world().camera_model());
}

void Run::take(const PictureRecord& record) {
  scorer_.add(record);
  csv_.add(record);
  if (video_) video_->add(record);
}

std::vector<core::StageTime> Run::stage_times() const {
  std::vector<core::StageTime> times = simulation_.stage_times();
  times.insert(times.end(),
               {reconstruction_.stage_time(), tracker_.stage_time(), handling_.time()});
  if (video_) times.push_back(filming_.time());
  std::ranges::stable_sort(times, {},
                           [](const core::StageTime& t) { return std::string_view(t.thread); });
  return times;
}

/// Publishes the earliest packet flown and has all modules do their work on it.
void Run::handle() {
  const std::size_t events = world_.publish();
  scorer_.add_events(static_cast<std::int64_t>(events));
  handling_([this] { return bus_.dispatch(); });
}

void Run::film() {
  if (video_) filming_([this] { video_->draw_chase(simulation_.world()); });
}

void Run::fly() {
  world_.take_setpoint();
  world_.fly();
  film();
  while (!end_.reached(simulation_.world().truth())) {
    world_.take_setpoint();
    world_.fly();
    handle();  // the packet before
    film();
    if (options_.on_progress)
      options_.on_progress(core::seconds(simulation_.world().now()), scenario_.duration_s,
                           to_string(phase_));
  }
  handle();
}

void Run::add_sensor_counts(Summary& summary) const {
  const sim::SimulatedCamera& camera = simulation_.camera();
  summary.events_lost = static_cast<std::int64_t>(camera.readout_counts().lost);
  summary.max_readout_delay_us = camera.readout_counts().max_delay.count();
  const sim::EmulatorCounts& pixels = camera.pixel_counts();
  summary.bad_radiance =
      static_cast<std::int64_t>(pixels.negative_radiance + pixels.not_finite_radiance);
  summary.renders = static_cast<std::int64_t>(simulation_.renders());
  summary.renders_late = static_cast<std::int64_t>(simulation_.drawn_late());
  if (summary.events_lost > 0) spdlog::warn("the readout lost {} events", summary.events_lost);
  if (summary.bad_radiance > 0)
    spdlog::warn("{} pixel values were negative or not finite", summary.bad_radiance);
}

Summary Run::finish(double wall_time_s) {
  if (video_) video_->finish();
  csv_.finish();
  log_.finish();
  Summary summary = scorer_.summary(simulation_.world().now(), wall_time_s);
  add_sensor_counts(summary);
  summary.profile = stage_times();
  folder_.write(kSummaryFile, to_json(summary));
  return summary;
}

}  // namespace

Summary run(const Scenario& scenario, const RunOptions& options) {
  check_source(scenario, camera::SourceType::simulation);
  const auto begin = std::chrono::steady_clock::now();
  Run flight(scenario, options);
  flight.fly();
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  return flight.finish(wall.count());
}

}  // namespace nightjar::scenarios
