#include "camera/caer_settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "camera/caer_addresses.h"
#include "tests/support/camera_caer_double.h"

namespace nightjar::camera {
namespace {

using testing::HasSubstr;

class CaerSettingsTest : public testing::Test {
 protected:
  void send(const CaerConfig& config) {
    device_ = bench_.opener()("");
    send_settings(config, *device_);
    start_data(config, *device_);
  }

  std::string error_of(const CaerConfig& config) {
    try {
      send(config);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "no error";
  }

  std::uint32_t sent(int module, int parameter) const {
    return bench_.settings.at({module, parameter});
  }

  test::CaerDouble bench_{std::vector<test::CaerDoubleSession>(1)};
  std::unique_ptr<CaerDevice> device_;
};

// What libcaer's caerBiasCoarseFineGenerate() gives for CF_N_TYPE(4, 39) and CF_P_TYPE(2, 58).
TEST_F(CaerSettingsTest, packs_a_bias_as_libcaer_does) {
  EXPECT_EQ(bias_bits({4, 39}, BiasKind::n_type), 0x427fu);
  EXPECT_EQ(bias_bits({2, 58}, BiasKind::p_type), 0x23adu);
}

TEST_F(CaerSettingsTest, sends_libcaers_own_values_unless_told_otherwise) {
  send({});
  EXPECT_EQ(sent(caer::kHostPackets, caer::kMaxContainerInterval), 10'000u);
  EXPECT_EQ(sent(caer::kHostDataExchange, caer::kBlocking), 1u);
  EXPECT_EQ(sent(caer::kHostDataExchange, caer::kBufferSize), 64u);
  EXPECT_EQ(sent(caer::kAps, caer::kApsExposure), 4'000u);
  EXPECT_EQ(sent(caer::kAps, caer::kApsFrameInterval), 40'000u);
  EXPECT_EQ(sent(caer::kDvs, caer::kFilterBackgroundActivity), 1u);
  EXPECT_EQ(sent(caer::kDvs, caer::kFilterBackgroundActivityTime), 8u);  // of 250 us
  EXPECT_EQ(sent(caer::kDvs, caer::kFilterRefractoryPeriod), 0u);
  EXPECT_EQ(sent(caer::kDvs, caer::kFilterRefractoryPeriodTime), 1u);
  EXPECT_EQ(sent(caer::kBias, caer::kBiasDiff), bias_bits({4, 39}, BiasKind::n_type));
  EXPECT_EQ(sent(caer::kBias, caer::kBiasOn), bias_bits({5, 255}, BiasKind::n_type));
  EXPECT_EQ(sent(caer::kBias, caer::kBiasOff), bias_bits({4, 1}, BiasKind::n_type));
  EXPECT_EQ(sent(caer::kBias, caer::kBiasPr), bias_bits({2, 58}, BiasKind::p_type));
  EXPECT_EQ(sent(caer::kBias, caer::kBiasPrSf), bias_bits({1, 16}, BiasKind::p_type));
  EXPECT_EQ(sent(caer::kBias, caer::kBiasRefr), bias_bits({4, 25}, BiasKind::p_type));
  EXPECT_EQ(bench_.noise_filter.at(caer::kNoiseBackgroundActivityEnable), 0u);
  EXPECT_EQ(bench_.noise_filter.at(caer::kNoiseHotPixelLearn), 0u);
  EXPECT_FALSE(bench_.settings.contains({caer::kAps, caer::kApsRun}));
  EXPECT_FALSE(bench_.settings.contains({caer::kImu, caer::kImuRunGyroscope}));
}

TEST_F(CaerSettingsTest, turns_frames_and_imu_off_once_the_start_turned_them_on) {
  CaerConfig config;
  config.frames = config.imu = false;
  send(config);
  EXPECT_FALSE(bench_.settings_before.contains({caer::kAps, caer::kApsRun}));
  EXPECT_EQ(sent(caer::kAps, caer::kApsRun), 0u);
  EXPECT_EQ(sent(caer::kImu, caer::kImuRunAccelerometer), 0u);
  EXPECT_EQ(sent(caer::kImu, caer::kImuRunGyroscope), 0u);
  EXPECT_EQ(sent(caer::kImu, caer::kImuRunTemperature), 0u);
}

TEST_F(CaerSettingsTest, switches_the_filters) {
  CaerConfig config;
  config.hardware_filter.background_activity = false;
  config.hardware_filter.learn_hot_pixels = true;
  config.software_filter.background_activity = true;
  config.software_filter.background_activity_ms = 5.0;
  config.software_filter.learn_hot_pixels = true;
  config.software_filter.hot_pixel_learning_s = 2.0;
  config.software_filter.hot_pixel_events = 500;
  send(config);
  EXPECT_EQ(sent(caer::kDvs, caer::kFilterBackgroundActivity), 0u);
  EXPECT_EQ(sent(caer::kDvs, caer::kFilterPixelAutoTrain), 1u);
  EXPECT_EQ(bench_.noise_filter.at(caer::kNoiseBackgroundActivityEnable), 1u);
  EXPECT_EQ(bench_.noise_filter.at(caer::kNoiseBackgroundActivityTime), 5'000u);
  EXPECT_EQ(bench_.noise_filter.at(caer::kNoiseHotPixelTime), 2'000'000u);
  EXPECT_EQ(bench_.noise_filter.at(caer::kNoiseHotPixelCount), 500u);
  EXPECT_EQ(bench_.noise_filter.at(caer::kNoiseHotPixelEnable), 1u);
  EXPECT_EQ(bench_.noise_filter.at(caer::kNoiseHotPixelLearn), 1u);
}

TEST_F(CaerSettingsTest, leaves_filters_alone_that_the_camera_has_not) {
  bench_.info.has_background_activity_filter = bench_.info.has_pixel_filter = false;
  send({});
  for (const auto& [address, value] : bench_.settings) EXPECT_NE(address.first, caer::kDvs);
}

TEST_F(CaerSettingsTest, names_what_the_camera_refuses) {
  bench_.refused = {caer::kBias, caer::kBiasOff};
  EXPECT_THAT(error_of({}), HasSubstr("DAVIS346 00000123: the camera does not take "
                                      "source.caer.biases"));
}

}  // namespace
}  // namespace nightjar::camera
