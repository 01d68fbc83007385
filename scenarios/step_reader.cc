#include "scenarios/step_reader.h"

#include "msg/log_reader.h"
#include "scenarios/log_steps.h"
#include "scenarios/recording_steps.h"

namespace nightjar::scenarios {

std::unique_ptr<StepReader> open_steps(const std::filesystem::path& path,
                                       std::optional<core::Resolution> size) {
  if (msg::is_log(path)) return std::make_unique<LogSteps>(path);
  return std::make_unique<RecordingSteps>(camera::open_recording(path, size));
}

}  // namespace nightjar::scenarios
