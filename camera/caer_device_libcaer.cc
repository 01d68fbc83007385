#include <fmt/format.h>
#include <libcaer/devices/davis.h>
#include <libcaer/filters/dvs_noise.h>

#include <atomic>
#include <cerrno>
#include <deque>
#include <mutex>
#include <stdexcept>
#include <string_view>

#include "camera/caer_addresses.h"
#include "camera/caer_device.h"

namespace nightjar::camera {
namespace {

static_assert(caer::kChipDavis346A == DAVIS_CHIP_DAVIS346A &&
              caer::kChipDavis346B == DAVIS_CHIP_DAVIS346B &&
              caer::kChipDavis346C == DAVIS_CHIP_DAVIS346C);
static_assert(caer::kHostDataExchange == CAER_HOST_CONFIG_DATAEXCHANGE &&
              caer::kBufferSize == CAER_HOST_CONFIG_DATAEXCHANGE_BUFFER_SIZE &&
              caer::kBlocking == CAER_HOST_CONFIG_DATAEXCHANGE_BLOCKING);
static_assert(caer::kHostPackets == CAER_HOST_CONFIG_PACKETS &&
              caer::kMaxContainerInterval == CAER_HOST_CONFIG_PACKETS_MAX_CONTAINER_INTERVAL);
static_assert(caer::kDvs == DAVIS_CONFIG_DVS &&
              caer::kFilterBackgroundActivity == DAVIS_CONFIG_DVS_FILTER_BACKGROUND_ACTIVITY &&
              caer::kFilterBackgroundActivityTime ==
                  DAVIS_CONFIG_DVS_FILTER_BACKGROUND_ACTIVITY_TIME &&
              caer::kFilterRefractoryPeriod == DAVIS_CONFIG_DVS_FILTER_REFRACTORY_PERIOD &&
              caer::kFilterRefractoryPeriodTime == DAVIS_CONFIG_DVS_FILTER_REFRACTORY_PERIOD_TIME &&
              caer::kFilterPixelAutoTrain == DAVIS_CONFIG_DVS_FILTER_PIXEL_AUTO_TRAIN);
static_assert(caer::kAps == DAVIS_CONFIG_APS && caer::kApsRun == DAVIS_CONFIG_APS_RUN &&
              caer::kApsExposure == DAVIS_CONFIG_APS_EXPOSURE &&
              caer::kApsFrameInterval == DAVIS_CONFIG_APS_FRAME_INTERVAL);
static_assert(caer::kImu == DAVIS_CONFIG_IMU &&
              caer::kImuRunAccelerometer == DAVIS_CONFIG_IMU_RUN_ACCELEROMETER &&
              caer::kImuRunGyroscope == DAVIS_CONFIG_IMU_RUN_GYROSCOPE &&
              caer::kImuRunTemperature == DAVIS_CONFIG_IMU_RUN_TEMPERATURE);
static_assert(caer::kBias == DAVIS_CONFIG_BIAS && caer::kBiasDiff == DAVIS346_CONFIG_BIAS_DIFFBN &&
              caer::kBiasOn == DAVIS346_CONFIG_BIAS_ONBN &&
              caer::kBiasOff == DAVIS346_CONFIG_BIAS_OFFBN &&
              caer::kBiasPr == DAVIS346_CONFIG_BIAS_PRBP &&
              caer::kBiasPrSf == DAVIS346_CONFIG_BIAS_PRSFBP &&
              caer::kBiasRefr == DAVIS346_CONFIG_BIAS_REFRBP);
static_assert(caer::kNoiseHotPixelLearn == CAER_FILTER_DVS_HOTPIXEL_LEARN &&
              caer::kNoiseHotPixelTime == CAER_FILTER_DVS_HOTPIXEL_TIME &&
              caer::kNoiseHotPixelCount == CAER_FILTER_DVS_HOTPIXEL_COUNT &&
              caer::kNoiseHotPixelEnable == CAER_FILTER_DVS_HOTPIXEL_ENABLE &&
              caer::kNoiseBackgroundActivityEnable == CAER_FILTER_DVS_BACKGROUND_ACTIVITY_ENABLE &&
              caer::kNoiseBackgroundActivityTime == CAER_FILTER_DVS_BACKGROUND_ACTIVITY_TIME &&
              caer::kNoiseRefractoryPeriodEnable == CAER_FILTER_DVS_REFRACTORY_PERIOD_ENABLE &&
              caer::kNoiseRefractoryPeriodTime == CAER_FILTER_DVS_REFRACTORY_PERIOD_TIME);

/// libcaer says in its log alone that a container found its ring buffer full. So count
/// those that went in, and remember behind which one any were lost.
class LossCount {
 public:
  void put() {
    const std::lock_guard lock(mutex_);
    ++put_;
  }

  void lose() {
    const std::lock_guard lock(mutex_);
    if (losses_.empty() || losses_.back().behind != put_) losses_.push_back({put_, 0});
    ++losses_.back().count;
  }

  /// A container comes out: those lost just before it.
  std::uint64_t take() {
    const std::lock_guard lock(mutex_);
    std::uint64_t lost = 0;
    for (; !losses_.empty() && losses_.front().behind <= taken_; losses_.pop_front())
      lost += losses_.front().count;
    ++taken_;
    return lost;
  }

 private:
  struct Loss {
    std::uint64_t behind = 0;
    std::uint64_t count = 0;
  };

  std::mutex mutex_;
  std::uint64_t put_ = 0;
  std::uint64_t taken_ = 0;
  std::deque<Loss> losses_;
};

/// The camera whose USB thread this is. A buffer that is full was put into before.
thread_local LossCount* losses_of_this_thread = nullptr;

void on_put(void* losses) {
  losses_of_this_thread = static_cast<LossCount*>(losses);
  losses_of_this_thread->put();
}

void on_log(const char* text, std::size_t length) {
  const bool lost = std::string_view(text, length).find("ring-buffer full") != std::string::npos;
  if (lost && losses_of_this_thread != nullptr) losses_of_this_thread->lose();
}

void on_shutdown(void* connected) { static_cast<std::atomic<bool>*>(connected)->store(false); }

/// libcaer's log, of the whole process: to us alone, from the level of a loss up.
void take_over_log() {
  caerLogLevelSet(CAER_LOG_NOTICE);
  caerLogFileDescriptorsSet(-1, -1);
  caerLogCallbackSet(on_log);
}

std::string why_not(int error) {
  switch (error) {
    case CAER_ERROR_FW_VERSION:
    case CAER_ERROR_LOGIC_VERSION:
      return "its firmware is too old: update it with iniVation's flashy";
    case CAER_ERROR_COMMUNICATION: return "it does not answer: unplug it and plug it in again";
    case CAER_ERROR_RESOURCE_ALLOCATION:
    case CAER_ERROR_MEMORY_ALLOCATION: return "the computer is out of memory or USB resources";
    default:
      return "is it plugged in, used by another program, and the udev rule installed "
             "(docs/hardware.md)?";
  }
}

struct CloseDevice {
  void operator()(caer_device_handle* handle) const { caerDeviceClose(&handle); }
};
struct FreeContainer {
  void operator()(caer_event_packet_container* container) const {
    caerEventPacketContainerFree(container);
  }
};
struct DestroyFilter {
  void operator()(caer_filter_dvs_noise* filter) const { caerFilterDVSNoiseDestroy(filter); }
};

class LibcaerDevice : public CaerDevice {
 public:
  explicit LibcaerDevice(caerDeviceHandle handle) : handle_(handle) {
    const caer_davis_info info = caerDavisInfoGet(handle);
    info_ = {info.deviceSerialNumber,
             info.chipID,
             {info.dvsSizeX, info.dvsSizeY},
             info.dvsHasPixelFilter,
             info.dvsHasBackgroundActivityFilter};
    filter_.reset(caerFilterDVSNoiseInitialize(static_cast<std::uint16_t>(info.dvsSizeX),
                                               static_cast<std::uint16_t>(info.dvsSizeY)));
    if (!filter_ || !caerDeviceSendDefaultConfig(handle))
      throw std::invalid_argument(
          fmt::format("DAVIS {}: does not take its settings", info_.serial));
  }

  ~LibcaerDevice() override {
    container_.reset();
    if (started_) caerDeviceDataStop(handle_.get());
  }

  CaerDeviceInfo info() const override { return info_; }

  bool set(std::int8_t module, std::uint8_t parameter, std::uint32_t value) override {
    return caerDeviceConfigSet(handle_.get(), module, parameter, value);
  }

  bool set_noise_filter(std::uint8_t parameter, std::uint64_t value) override {
    return caerFilterDVSNoiseConfigSet(filter_.get(), parameter, value);
  }

  bool start() override {
    started_ =
        caerDeviceDataStart(handle_.get(), on_put, nullptr, &losses_, on_shutdown, &connected_);
    return started_;
  }

  bool read(CaerContainer& container) override {
    container = {};
    container_.reset(caerDeviceDataGet(handle_.get()));
    if (!container_) return false;
    container.lost_before = losses_.take();
    const std::int32_t packets = caerEventPacketContainerGetEventPacketsNumber(container_.get());
    for (std::int32_t i = 0; i < packets; ++i) {
      const caerEventPacketHeader packet =
          caerEventPacketContainerGetEventPacket(container_.get(), i);
      if (packet == nullptr) continue;
      if (caerEventPacketHeaderGetEventType(packet) == POLARITY_EVENT)
        caerFilterDVSNoiseApply(filter_.get(), reinterpret_cast<caerPolarityEventPacket>(packet));
      container.packets.emplace_back(
          reinterpret_cast<const std::byte*>(packet),
          static_cast<std::size_t>(caerEventPacketGetSizeEvents(packet)));
    }
    return true;
  }

  bool connected() const override { return connected_; }

  // The setting is an atomic of libcaer's, which a read() that waits looks at every
  // millisecond.
  void interrupt() override {
    caerDeviceConfigSet(handle_.get(), caer::kHostDataExchange, caer::kBlocking, 0);
  }

 private:
  // What libcaer's USB thread writes to goes after the handle, whose closing ends it.
  LossCount losses_;
  std::atomic<bool> connected_ = true;
  std::unique_ptr<caer_device_handle, CloseDevice> handle_;
  std::unique_ptr<caer_filter_dvs_noise, DestroyFilter> filter_;
  std::unique_ptr<caer_event_packet_container, FreeContainer> container_;
  CaerDeviceInfo info_;
  bool started_ = false;
};

}  // namespace

std::unique_ptr<CaerDevice> open_caer_device(const std::string& serial) {
  constexpr std::uint16_t kId = 1;  // names the source of the packets; we have but one
  take_over_log();
  errno = 0;
  const caerDeviceHandle handle =
      caerDeviceOpen(kId, CAER_DEVICE_DAVIS, 0, 0, serial.empty() ? nullptr : serial.c_str());
  if (handle == nullptr)
    throw std::invalid_argument(
        fmt::format("source.caer.serial = \"{}\": no {} could be opened; {}", serial,
                    serial.empty() ? "DAVIS" : "such DAVIS", why_not(errno)));
  return std::make_unique<LibcaerDevice>(handle);
}

}  // namespace nightjar::camera
