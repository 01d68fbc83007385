#include "scenarios/send_camera.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "msg/channels.h"

namespace nightjar::scenarios {
namespace {

constexpr core::Time kLongestPacket = std::chrono::minutes(35);  // see msg::encode()

core::Time begin_of(const camera::LivePacket& packet) {
  if (packet.end - packet.begin <= kLongestPacket) return packet.begin;
  const core::Time first = packet.events.empty() ? packet.end : packet.events.front().t;
  return std::max(first - core::Time(1), packet.end - kLongestPacket);
}

void publish(camera::LivePacket& packet, msg::Bus& bus) {
  for (const camera::Trigger& trigger : packet.triggers)
    bus.publish(msg::kTrigger, msg::TriggerNote{trigger.t, trigger.type});
  for (const camera::RecordedImu& sample : packet.imu)
    bus.publish<core::ImuSample>(msg::kImu, sample);
  for (const camera::RecordedFrame& frame : packet.frames)
    bus.publish<core::ApsFrame>(msg::kApsFrame, frame);
  core::EventPacket events{begin_of(packet), packet.end, std::move(packet.events)};
  bus.publish(msg::kEvents, events);
  packet.events = std::move(events.events);  // their room serves the next packet
}

}  // namespace

void send_camera(camera::EventSource& camera, SourceLink& link) {
  camera.start();
  CameraReport& report = link.meter().total().camera.emplace();
  report.name = camera.name();
  camera::LivePacket packet;
  for (camera::Arrival arrival{}; arrival != camera::Arrival::end;) {
    arrival = camera.next(packet);
    report.counts = camera.counts();
    report.connected = report.counts.disconnects == report.counts.reconnects;
    if (arrival != camera::Arrival::packet) {
      link.idle();
      continue;
    }
    if (report.counts.packets == 1)
      link.inside().publish(msg::kSensor,
                            msg::SensorNote{packet.begin, camera.size(), camera.name()});
    publish(packet, link.inside());
    link.exchange(packet.end,
                  std::chrono::duration_cast<core::Time>(packet.received.time_since_epoch()));
  }
}

}  // namespace nightjar::scenarios
