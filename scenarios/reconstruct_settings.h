#pragma once

#include <filesystem>
#include <string>

#include "esi/config.h"
#include "tracker/config.h"

namespace nightjar::scenarios {

/// What of a scenario file matters to a recording: its sections reconstructor and
/// tracker.detector, under the same names.
struct ReconstructSettings {
  struct Tracker {
    tracker::DetectorConfig detector;

    template <class Visitor>
    void visit(Visitor& v) {
      v.section("detector", detector);
    }
  };

  esi::ReconstructorConfig reconstructor;
  Tracker tracker;

  template <class Visitor>
  void visit(Visitor& v) {
    v.section("reconstructor", reconstructor);
    v.section("tracker", tracker);
  }
};

/// Takes what the YAML file says, defaults for the rest. Weights are meant from the file's own
/// folder. Throws ScenarioError with file, line and column for an unknown key or a value not
/// allowed.
void read_settings(const std::filesystem::path& file, ReconstructSettings& settings);

/// Takes one "reconstructor.esi.decay_rate_hz=2". Throws ScenarioError, quoting it, for
/// anything that a file may not say.
void apply_setting(const std::string& assignment, ReconstructSettings& settings);

/// Names the networks' weights, which are meant from the folder `from`, as from `to`.
void move_weights(esi::ReconstructorConfig& config, const std::filesystem::path& from,
                  const std::filesystem::path& to);

}  // namespace nightjar::scenarios
