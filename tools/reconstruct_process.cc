#include "tools/reconstruct_process.h"

#include <CLI/CLI.hpp>
#include <stdexcept>

#include "scenarios/processes.h"
#include "scenarios/scenario.h"

namespace nightjar::tools {

void ReconstructProcess::declare(CLI::App& command) {
  auto* lcm = command.add_flag("--lcm", wanted,
                               "be a process of a running loop: instead of a RECORDING the "
                               "SCENARIO's YAML file, pictures out over LCM until stopped");
  for (CLI::Option* other : command.get_options())
    if (other != lcm && other->nonpositional() && !other->check_lname("json") &&
        !other->check_lname("quiet") && !other->check_lname("help"))
      lcm->excludes(other);
  command.add_option("--lcm-url", options.lcm_url, "where the processes meet")
      ->capture_default_str()
      ->needs(lcm)
      ->type_name("URL");
}

void ReconstructProcess::run(const std::string& scenario_file) const {
  if (scenario_file.empty())
    throw std::invalid_argument("which SCENARIO? See nightjar reconstruct --help");
  const scenarios::Scenario scenario = scenarios::load(scenario_file);
  serve(options,
        scenarios::reconstruction_process(scenario.reconstructor,
                                          {scenario.camera.width_px, scenario.camera.height_px}));
}

}  // namespace nightjar::tools
