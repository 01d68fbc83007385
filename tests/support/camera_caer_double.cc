#include "tests/support/camera_caer_double.h"

#include <stdexcept>

#include "camera/aedat31_format.h"

namespace nightjar::test {
namespace {

template <class T>
std::string bytes_of(const T& value) {
  return {reinterpret_cast<const char*>(&value), sizeof(value)};
}

}  // namespace

std::string caer_packet(int type, int event_size, int overflow, int number,
                        const std::string& events) {
  const camera::Aedat31PacketHeader header{
      static_cast<std::int16_t>(type), 1, event_size, 4, overflow, number, number, number};
  return bytes_of(header) + events;
}

std::string caer_polarity(std::uint32_t x, std::uint32_t y, bool on, std::int32_t t_us) {
  return bytes_of(1u | (on ? 2u : 0u) | (y << 2) | (x << 17)) + bytes_of(t_us);
}

std::string caer_special(std::uint32_t type, std::int32_t t_us) {
  return bytes_of(1u | (type << 1)) + bytes_of(t_us);
}

std::string caer_imu6(std::int32_t t_us) {
  std::string event = bytes_of(1u) + bytes_of(t_us);
  for (const float value : {0.f, -1.f, 0.f, 10.f, 20.f, 30.f, 25.f}) event += bytes_of(value);
  return event;
}

std::string caer_frame(std::int32_t begin_us, std::int32_t end_us,
                       const std::vector<std::uint16_t>& levels) {
  std::string event = bytes_of(1u | (1u << 1));
  for (const std::int32_t t_us : {begin_us, end_us, begin_us, end_us}) event += bytes_of(t_us);
  for (const std::int32_t number : {static_cast<std::int32_t>(levels.size()), 1, 0, 0})
    event += bytes_of(number);
  for (const std::uint16_t level : levels) event += bytes_of(level);
  return event;
}

std::string caer_events_at(int overflow, const std::vector<std::int32_t>& times_us) {
  std::string events;
  for (const std::int32_t t_us : times_us) events += caer_polarity(7, 9, true, t_us);
  return caer_packet(1, 8, overflow, static_cast<int>(times_us.size()), events);
}

/// One opening of the camera.
class CaerDouble::Device : public camera::CaerDevice {
 public:
  Device(CaerDouble& bench, CaerDoubleSession session)
      : bench_(bench), session_(std::move(session)) {}

  camera::CaerDeviceInfo info() const override { return bench_.info; }

  bool set(std::int8_t module, std::uint8_t parameter, std::uint32_t value) override {
    if (bench_.refused == Address{module, parameter}) return false;
    bench_.settings[{module, parameter}] = value;
    return true;
  }

  bool set_noise_filter(std::uint8_t parameter, std::uint64_t value) override {
    bench_.noise_filter[parameter] = value;
    return true;
  }

  bool start() override {
    bench_.settings_before = bench_.settings;
    return true;
  }

  bool read(camera::CaerContainer& container) override {
    container = {};
    if (next_ == session_.containers.size()) {
      if (!session_.unplugged_then && !bench_.silence_times_out) wait_for_interrupt();
      return false;
    }
    const CaerDoubleContainer& played = session_.containers[next_++];
    for (const std::string& packet : played.packets)
      container.packets.push_back(std::as_bytes(std::span(packet)));
    container.lost_before = played.lost_before;
    const std::lock_guard lock(bench_.mutex_);
    bench_.host_time_ = played.host_time;
    return true;
  }

  bool connected() const override {
    return !session_.unplugged_then || next_ < session_.containers.size();
  }

  void interrupt() override {
    const std::lock_guard lock(mutex_);
    interrupted_ = true;
    changed_.notify_all();
  }

 private:
  void wait_for_interrupt() {
    {
      const std::lock_guard lock(bench_.mutex_);
      bench_.silent_ = true;
      bench_.silence_.notify_all();
    }
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return interrupted_; });
  }

  CaerDouble& bench_;
  CaerDoubleSession session_;
  std::size_t next_ = 0;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool interrupted_ = false;
};

CaerDouble::CaerDouble(std::vector<CaerDoubleSession> sessions)
    : sessions_(sessions.begin(), sessions.end()) {}

camera::CaerOpener CaerDouble::opener() {
  return [this](const std::string& serial) -> std::unique_ptr<camera::CaerDevice> {
    serial_asked = serial;
    if (sessions_.empty() || sessions_.front().failures_before-- > 0)
      throw std::invalid_argument("no camera on the bench");
    auto device = std::make_unique<Device>(*this, std::move(sessions_.front()));
    sessions_.pop_front();
    ++opened;
    return device;
  };
}

void CaerDouble::wait_for_silence() {
  std::unique_lock lock(mutex_);
  silence_.wait(lock, [&] { return silent_; });
}

std::chrono::steady_clock::time_point CaerDouble::now() const {
  const std::lock_guard lock(mutex_);
  return std::chrono::steady_clock::time_point(host_time_);
}

}  // namespace nightjar::test
