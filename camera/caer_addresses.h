#pragma once

#include <cstdint>

namespace nightjar::camera::caer {

// Where libcaer 3.3 and the DAVIS have their settings: modules, and the parameters within
// one. caer_device_libcaer.cc holds them against libcaer's headers as it is compiled.

inline constexpr int kChipDavis346A = 4;
inline constexpr int kChipDavis346B = 5;
inline constexpr int kChipDavis346C = 9;

inline constexpr std::int8_t kHostDataExchange = -2;
inline constexpr std::uint8_t kBufferSize = 0;
inline constexpr std::uint8_t kBlocking = 1;

inline constexpr std::int8_t kHostPackets = -3;
inline constexpr std::uint8_t kMaxContainerInterval = 1;  // us

inline constexpr std::int8_t kDvs = 1;
inline constexpr std::uint8_t kFilterBackgroundActivity = 31;
inline constexpr std::uint8_t kFilterBackgroundActivityTime = 32;  // steps of 250 us
inline constexpr std::uint8_t kFilterRefractoryPeriod = 33;
inline constexpr std::uint8_t kFilterRefractoryPeriodTime = 34;  // steps of 250 us
inline constexpr std::uint8_t kFilterPixelAutoTrain = 100;

inline constexpr std::int8_t kAps = 2;
inline constexpr std::uint8_t kApsRun = 4;
inline constexpr std::uint8_t kApsExposure = 12;       // us
inline constexpr std::uint8_t kApsFrameInterval = 13;  // us

inline constexpr std::int8_t kImu = 3;
inline constexpr std::uint8_t kImuRunAccelerometer = 2;
inline constexpr std::uint8_t kImuRunGyroscope = 3;
inline constexpr std::uint8_t kImuRunTemperature = 4;

inline constexpr std::int8_t kBias = 5;
inline constexpr std::uint8_t kBiasDiff = 10;
inline constexpr std::uint8_t kBiasOn = 11;
inline constexpr std::uint8_t kBiasOff = 12;
inline constexpr std::uint8_t kBiasPr = 14;
inline constexpr std::uint8_t kBiasPrSf = 15;
inline constexpr std::uint8_t kBiasRefr = 16;

// Of the software filter; times in us.
inline constexpr std::uint8_t kNoiseHotPixelLearn = 0;
inline constexpr std::uint8_t kNoiseHotPixelTime = 1;
inline constexpr std::uint8_t kNoiseHotPixelCount = 2;
inline constexpr std::uint8_t kNoiseHotPixelEnable = 3;
inline constexpr std::uint8_t kNoiseBackgroundActivityEnable = 5;
inline constexpr std::uint8_t kNoiseBackgroundActivityTime = 6;
inline constexpr std::uint8_t kNoiseRefractoryPeriodEnable = 8;
inline constexpr std::uint8_t kNoiseRefractoryPeriodTime = 9;

}  // namespace nightjar::camera::caer
