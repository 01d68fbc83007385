#include "tools/sensor_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace nightjar::tools {
namespace {

using testing::ThrowsMessage;

TEST(SensorOptionsTest, a_size_is_two_numbers_with_an_x_between_them) {
  EXPECT_EQ(parse_size("346x260"), (core::Resolution{346, 260}));
  EXPECT_EQ(parse_size("1x32767"), (core::Resolution{1, 32767}));
  for (const char* text :
       {"", "x", "346", "346x", "x260", "346x260x1", "346x260 ", " 346x260", "+346x260", "346X260",
        "3.5x4", "0x5", "5x0", "-3x4", "32768x5", "99999999999x9"})
    EXPECT_THROW(parse_size(text), std::invalid_argument) << text;
  EXPECT_THAT([] { parse_size("0x5"); },
              ThrowsMessage<std::invalid_argument>(
                  "--size = 0x5, expected WIDTHxHEIGHT as in 346x260, allowed 1 to 32767 each"));
}

TEST(SensorOptionsTest, a_preset_goes_by_its_name_but_for_custom) {
  EXPECT_EQ(parse_preset("dim"), sim::SensorPreset::dim);
  EXPECT_EQ(parse_preset("by_illuminance"), sim::SensorPreset::by_illuminance);
  EXPECT_EQ(preset_names(), "by_illuminance, clean, bright, dim");
  for (const char* name : {"custom", "", "Dim", "dusk"})
    EXPECT_THAT([&] { parse_preset(name); },
                ThrowsMessage<std::invalid_argument>(std::string("--preset = ") + name +
                                                     ", allowed " + preset_names()));
}

}  // namespace
}  // namespace nightjar::tools
