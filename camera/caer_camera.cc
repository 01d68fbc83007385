#include "camera/caer_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "camera/caer_addresses.h"
#include "camera/caer_packets.h"
#include "camera/caer_settings.h"
#include "camera/gray_level.h"
#include "core/config_check.h"

namespace nightjar::camera {
namespace {

constexpr int kFrameBits = 10;  // of a DAVIS346's converter, whatever a frame happens to use
constexpr std::chrono::seconds kSilence(1);

std::chrono::microseconds from_ms(double time_ms) { return core::from_seconds(time_ms * 1e-3); }

/// Throws std::invalid_argument unless it is a camera that the settings are meant for.
void check_chip(const CaerDeviceInfo& info) {
  const bool known = info.chip == caer::kChipDavis346A || info.chip == caer::kChipDavis346B ||
                     info.chip == caer::kChipDavis346C;
  if (!known || info.size != CaerCamera::kSize)
    throw std::invalid_argument(
        fmt::format("camera {}: chip {} of {}x{}, allowed is a DAVIS346 of {}x{}", info.serial,
                    info.chip, info.size.width_px, info.size.height_px, CaerCamera::kSize.width_px,
                    CaerCamera::kSize.height_px));
}

/// Applies `change` to every time in the packet.
template <class Change>
void for_each_time(RecordingPart& part, const Change& change) {
  for (core::Event& each : part.events) change(each.t);
  for (RecordedFrame& each : part.frames)
    for (core::Time* t :
         {&each.frame_begin, &each.frame_end, &each.exposure_begin, &each.exposure_end})
      change(*t);
  for (RecordedImu& each : part.imu) change(each.t);
  for (Trigger& each : part.triggers) change(each.t);
}

bool is_empty(const RecordingPart& part) {
  return part.events.empty() && part.frames.empty() && part.imu.empty() && part.triggers.empty();
}

void add(RecordingFaults& sum, const RecordingFaults& more) {
  sum.bytes_lost += more.bytes_lost;
  sum.packets_unknown += more.packets_unknown;
  sum.packets_damaged += more.packets_damaged;
  sum.events_outside += more.events_outside;
  sum.events_backwards += more.events_backwards;
  sum.time_resets += more.time_resets;
  if (sum.first.empty()) sum.first = more.first;
}

}  // namespace

CaerCamera::CaerCamera(const CaerConfig& config, CaerOpener open, HostClock now)
    : config_(config), open_camera_(std::move(open)), now_(std::move(now)) {
  core::check_config(config_, "source.caer");
}

CaerCamera::~CaerCamera() { close(); }

std::string CaerCamera::name() const {
  const std::lock_guard lock(mutex_);
  return serial_.empty() ? "DAVIS346" : "DAVIS346 " + serial_;
}

void CaerCamera::start() {
  open();
  end_received_ = now_();
}

SourceCounts CaerCamera::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

void CaerCamera::stop() {
  const std::lock_guard lock(mutex_);
  stopping_ = true;
  if (device_) device_->interrupt();
  stopped_.notify_all();
}

/// Opens the camera and lets its data flow, with all that depends on its clock anew.
void CaerCamera::open() {
  std::unique_ptr<CaerDevice> device = open_camera_(config_.serial);
  const CaerDeviceInfo info = device->info();
  check_chip(info);
  send_settings(config_, *device);
  start_data(config_, *device);
  add(earlier_faults_, intake_.faults());
  intake_ = RecordingIntake(kSize);
  intake_.set_place([this, serial = info.serial] {
    return fmt::format("DAVIS346 {}: container {}", serial, containers_);
  });
  containers_ = 0;
  const std::lock_guard lock(mutex_);
  device_ = std::move(device);
  serial_ = info.serial;
}

void CaerCamera::close() {
  std::unique_ptr<CaerDevice> device;
  const std::lock_guard lock(mutex_);
  device = std::move(device_);  // closed by its destructor, once the lock is gone
}

Arrival CaerCamera::next(LivePacket& packet) {
  packet.clear();
  packet.gap = false;
  while (!stopping_) {
    if (!device_) {
      if (const Arrival found = look_for_camera(); found != Arrival::packet) return found;
    } else if (device_->read(container_)) {
      if (take(packet)) return Arrival::packet;
    } else if (!stopping_) {
      return device_->connected() ? Arrival::silent : lose_camera();
    }
  }
  close();
  return Arrival::end;
}

Arrival CaerCamera::lose_camera() {
  close();
  pause_ = from_ms(config_.reconnect.first_pause_ms);
  next_attempt_ = std::chrono::steady_clock::now() + pause_;
  const std::lock_guard lock(mutex_);
  ++counts_.disconnects;
  return Arrival::disconnected;
}

/// Waits for the next attempt to open the camera and makes it. `packet` when it is there
/// again and may be read.
Arrival CaerCamera::look_for_camera() {
  {
    std::unique_lock lock(mutex_);
    const auto silence = std::chrono::steady_clock::now() + kSilence;
    stopped_.wait_until(lock, std::min(next_attempt_, silence), [&] { return stopping_.load(); });
    if (stopping_) return Arrival::end;
    if (std::chrono::steady_clock::now() < next_attempt_) return Arrival::silent;
  }
  try {
    open();
  } catch (const std::invalid_argument&) {  // not there yet, or gone again at once
    pause_ = std::min(2 * pause_, from_ms(config_.reconnect.most_pause_ms));
    next_attempt_ = std::chrono::steady_clock::now() + pause_;
    return Arrival::silent;
  }
  gap_ = true;
  shift_known_ = false;
  const std::lock_guard lock(mutex_);
  ++counts_.reconnects;
  return Arrival::packet;
}

/// Decodes the container at hand; false when nothing of it is to be handed over.
bool CaerCamera::take(LivePacket& packet) {
  packet.received = now_();
  gap_ = gap_ || container_.lost_before > 0;
  for (const std::span<const std::byte> each : container_.packets)
    decode_caer_packet(each, intake_, packet);
  ++containers_;
  for (RecordedFrame& frame : packet.frames) {
    frame.gray = with_bits(std::move(frame.gray), frame.bits, kFrameBits);
    frame.bits = kFrameBits;
  }
  const bool any = !is_empty(packet);
  if (any) {
    place_in_time(packet);
    packet.gap = std::exchange(gap_, false);
  }
  count(packet, container_.lost_before);
  return any;
}

/// Brings the packet's times from the camera's clock to the source's and gives it its
/// interval.
void CaerCamera::place_in_time(LivePacket& packet) {
  constexpr core::Time kLeast(1);
  core::Time first = core::Time::max(), last = core::Time::min();
  for_each_time(packet, [&](core::Time t) {
    first = std::min(first, t);
    last = std::max(last, t);
  });
  if (!shift_known_) {  // the outage lasted as long as the computer's clock says
    const auto away = packet.received - end_received_;
    shift_ = end_ + std::chrono::duration_cast<core::Time>(away) - last;
    shift_known_ = true;
  }
  if (!any_packet_) end_ = std::max(core::Time{}, first - kLeast);
  any_packet_ = true;
  packet.begin = end_;
  for_each_time(packet, [&](core::Time& t) { t += shift_; });
  for (core::Event& event : packet.events) {
    if (event.t > packet.begin) break;
    event.t = packet.begin + kLeast;  // as old as the packet before: after a reset, say
  }
  packet.end = std::max(last + shift_, packet.begin);
  if (!packet.events.empty()) packet.end = std::max(packet.end, packet.events.back().t);
  end_ = packet.end;
  end_received_ = packet.received;
}

void CaerCamera::count(const LivePacket& packet, std::uint64_t packets_lost) {
  const std::lock_guard lock(mutex_);
  counts_.packets += is_empty(packet) ? 0 : 1;
  counts_.events += packet.events.size();
  counts_.frames += packet.frames.size();
  counts_.imu += packet.imu.size();
  counts_.triggers += packet.triggers.size();
  counts_.packets_lost += packets_lost;
  counts_.faults = earlier_faults_;
  add(counts_.faults, intake_.faults());
}

}  // namespace nightjar::camera
