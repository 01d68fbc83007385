#pragma once

#include <functional>
#include <optional>
#include <string>

#include "scenarios/node_process.h"
#include "scenarios/process_report.h"
#include "scenarios/process_roles.h"
#include "scenarios/source_link.h"

namespace CLI {
class App;
}

namespace nightjar::tools {

/// What all processes of a distributed loop are asked alike.
struct ProcessOptions {
  std::string lcm_url = scenarios::kDefaultUrl;
  bool json = false;
  bool quiet = false;

  void declare(CLI::App& command);
};

/// For sources, also how they wait for the others.
struct SourceOptions : ProcessOptions {
  bool lockstep = false;
  bool free_running = false;

  void declare(CLI::App& command);
};

/// What the help of each of these commands says about running together.
extern const char* const kProcessNotes;

/// Serves until SIGINT or SIGTERM, reports once a second on stderr and at the end.
void serve(const ProcessOptions& options, scenarios::NodeProcess::Setup setup,
           const std::string* estimates_sha256 = nullptr);

/// Has `fly` send over a link, reports once a second on stderr and at the end, which a
/// signal may bring on: then throws Interrupted after the report.
void send(const ProcessOptions& options, bool lock_step, std::optional<scenarios::Sending> answers,
          const std::function<void(scenarios::SourceLink&)>& fly);

}  // namespace nightjar::tools
