// Any bytes at all are either a scenario, which then reads back as it was
// written, or a ScenarioError. Anything else is a finding.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "scenarios/scenario.h"
#include "scenarios/scenario_error.h"
#include "scenarios/yaml_reader.h"
#include "scenarios/yaml_writer.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace nightjar::scenarios;
  Scenario scenario;
  try {
    read_yaml({reinterpret_cast<const char*>(data), size}, "fuzz.yaml", scenario);
  } catch (const ScenarioError&) {
    return 0;
  }
  const std::string written = to_yaml(scenario);
  Scenario again;
  read_yaml(written, "written.yaml", again);
  if (to_yaml(again) != written) std::abort();
  return 0;
}
