#pragma once

namespace CLI {
class App;
}

namespace nightjar::tools {

/// Adds `nightjar sensor-report`, which shows how the simulated event sensor behaves,
/// beside a recording of a real one if given. Bad input throws std::invalid_argument,
/// Ctrl-C Interrupted, a missing gnuplot std::runtime_error.
void add_sensor_report_command(CLI::App& app);

}  // namespace nightjar::tools
