#include "tools/process_options.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <iostream>
#include <utility>

#include "tools/interrupt.h"

namespace nightjar::tools {
namespace {

using namespace std::chrono_literals;

/// Says once a second how a process is getting on.
class EverySecond {
 public:
  EverySecond(const ProcessOptions& options, scenarios::ProcessMeter& meter)
      : quiet_(options.quiet), meter_(meter) {}

  void operator()() {
    const auto now = std::chrono::steady_clock::now();
    if (quiet_ || now < next_) return;
    next_ = now + 1s;
    const scenarios::ProcessReport report = meter_.take_interval();
    const bool idle = report.steps == 0 && !report.camera;  // of a camera silence is news
    if (!idle || !told_idle_)
      std::cerr << (idle ? report.process + ": waiting" : to_line(report)) << std::endl;
    told_idle_ = idle;
  }

 private:
  bool quiet_;
  scenarios::ProcessMeter& meter_;
  std::chrono::steady_clock::time_point next_ = std::chrono::steady_clock::now();
  bool told_idle_ = false;
};

void tell_result(const ProcessOptions& options, const scenarios::ProcessReport& report) {
  if (report.refused > 0)
    std::cerr << "nightjar: warning: " << report.refused
              << " messages could not be used, the first: " << report.first_refusal << '\n';
  if (options.json)
    std::cout << to_json(report) << std::flush;
  else if (!options.quiet)
    std::cout << to_line(report) << std::endl;
}

}  // namespace

const char* const kProcessNotes = R"(
One source (nightjar simulate, nightjar camera, nightjar replay), nightjar reconstruct
--lcm and nightjar track make one loop, started in any order. The source decides: in
lock-step a step is sent again until it is answered and none is lost; free-running keeps
real time. When a source begins anew the others do too.

The default url, udpm://239.255.76.67:7667?ttl=0, does not leave this computer. It wants a
multicast route on the loopback device: ip link set lo multicast on; ip route add
224.0.0.0/4 dev lo. For many events a second also: sysctl net.core.rmem_max=4194304.

Once a second, on stderr, and at the end each process tells its rate, its latency (from
the source's having a packet to this process's being done with it) and what was lost.)";

void ProcessOptions::declare(CLI::App& command) {
  command.add_option("--lcm-url", lcm_url, "where the processes meet")
      ->capture_default_str()
      ->type_name("URL");
  command.add_flag("--json", json, "print the report at the end as JSON");
  command.add_flag("--quiet", quiet, "no report each second, no line at the end");
}

void SourceOptions::declare(CLI::App& command) {
  ProcessOptions::declare(command);
  auto* lock = command.add_flag("--lockstep", lockstep, "wait for the answer to each packet");
  command.add_flag("--free-running", free_running, "keep real time")->excludes(lock);
}

void serve(const ProcessOptions& options, scenarios::NodeProcess::Setup setup,
           const std::string* estimates_sha256) {
  msg::Bus wire(options.lcm_url);
  scenarios::NodeProcess process(wire, std::move(setup));
  EverySecond tell(options, process.meter());
  note_interrupts();
  while (!interrupted()) {
    process.serve(50ms);
    tell();
  }
  scenarios::ProcessReport report = process.meter().report();
  if (estimates_sha256) report.estimates_sha256 = *estimates_sha256;
  tell_result(options, report);
}

void send(const ProcessOptions& options, bool lock_step, std::optional<scenarios::Sending> answers,
          const std::function<void(scenarios::SourceLink&)>& fly) {
  msg::Bus wire(options.lcm_url);
  std::function<void()> tell = [] {};
  const auto while_waiting = [&tell] {
    tell();
    throw_if_interrupted();
  };
  scenarios::SourceLink link(wire, std::move(answers), {lock_step, while_waiting});
  tell = EverySecond(options, link.meter());
  note_interrupts();
  try {
    fly(link);
  } catch (const Interrupted&) {
    tell_result(options, link.meter().report());
    throw;
  }
  tell_result(options, link.meter().report());
}

}  // namespace nightjar::tools
