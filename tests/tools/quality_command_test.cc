#include <gtest/gtest.h>

#include <fstream>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>

#include "scenarios/gray_picture.h"
#include "scenarios/recordings.h"
#include "tests/support/data_folder.h"
#include "tests/support/program.h"

namespace nightjar::tools {
namespace {

namespace fs = std::filesystem;

class QualityCommandTest : public test::ProgramTest {
 protected:
  QualityCommandTest() {
    core::Image<std::uint8_t> picture({16, 16}, 50);
    std::ofstream events(folder_ / "events.txt");
    for (int i = 0; i < 2; ++i)
      for (int y = 4; y < 12; ++y)
        for (int x = 4; x < 12; ++x) {
          events << "0.0" << i + 1 << ' ' << x << ' ' << y << " 1\n";
          picture(x, y) = 200;
        }
    scenarios::write_png(folder_ / "frame.png", picture);
  }

  /// A table without complaint that has a row for each of these methods.
  void expect_rows(std::initializer_list<std::string> methods) const {
    EXPECT_EQ(err, "");
    EXPECT_TRUE(out.starts_with("method ")) << out;
    for (const std::string& method : methods)
      EXPECT_NE(out.find('\n' + method + ' '), std::string::npos) << method << out;
  }

  /// A square turns bright by 30 ms, beside a line that always was; frames of them, the third
  /// exposed for long, 20, 100, 200 and 300 ms after the first event.
  void write_flight() const {
    constexpr core::Resolution kSensor{16, 16};
    camera::RecordingPart part;
    camera::RecordedFrame frame;
    frame.gray = core::Image<std::uint16_t>(kSensor, 50);
    for (const int ms : {10, 20, 400})
      for (std::uint16_t y = 4; y < 12; ++y)
        for (std::uint16_t x = 4; x < 12; ++x) {
          part.events.push_back({core::Time(1000 * ms), x, y, true});
          frame.gray(x, y) = 200;
        }
    for (const int ms : {30, 110, 210, 310}) {
      const core::Time half = core::Time(ms == 210 ? 30'000 : 4'000);
      frame.frame_begin = frame.exposure_begin = core::Time(1000 * ms) - half;
      frame.frame_end = frame.exposure_end = core::Time(1000 * ms) + half;
      part.frames.push_back(frame);
    }
    for (camera::RecordedFrame& each : part.frames)
      for (int y = 4; y < 12; ++y) each.gray(1, y) = 200;
    const auto writer = scenarios::create_recording(folder_ / "flight.aedat4", {kSensor, ""});
    writer->write(part);
    writer->finish();
  }
};

TEST_F(QualityCommandTest, prints_a_row_for_every_method) {
  ASSERT_EQ(run_program("quality events.txt --reference frame.png"), 0) << err;
  expect_rows({"esi", "accumulator", "complementary_filter", "htac"});
  EXPECT_NE(out.find("skipped: needs frames"), std::string::npos) << out;
  EXPECT_NE(out.find("skipped: no weights"), std::string::npos) << out;
  EXPECT_EQ(out.find("compared"), std::string::npos) << out;
}

TEST_F(QualityCommandTest, compares_with_the_recordings_own_frames) {
  write_flight();
  ASSERT_EQ(run_program("quality flight.aedat4"), 0) << err;
  expect_rows({"esi", "edi", "fedi", "esi_net"});
  EXPECT_EQ(out.find("skipped: needs"), std::string::npos) << out;
  EXPECT_TRUE(
      out.ends_with("\n2 frames compared, 2 left out: 1 too early, 1 exposed for too "
                    "long\n"))
      << out;
}

TEST_F(QualityCommandTest, compares_the_frames_it_is_told_to) {
  write_flight();
  ASSERT_EQ(run_program("quality flight.aedat4 --method edi --from 0 --until 0.2 --max-exposure 70 "
                        "--json"),
            0)
      << err;
  const auto json = nlohmann::json::parse(out);
  EXPECT_EQ(json["frames"]["compared"], 3);  // at 20, 100 and 200 ms
  const auto& edi = json["methods"][0];
  ASSERT_EQ(edi["frames"].size(), 3u);
  EXPECT_EQ(edi["frames"][1]["time_us"], 110'000);      // the first event was at 10 ms
  EXPECT_NEAR(edi["frames"][1]["explained"], 1, 1e-9);  // it had seen the same before ...
  // ... and here only events: r^2 of a square of 64 of 256 px and that with a line of 8 px.
  EXPECT_NEAR(edi["frames"][0]["explained"], 23.0 / 27, 1e-9);
  EXPECT_EQ(edi["saw_frames"], true);
}

TEST_F(QualityCommandTest, says_how_long_exposures_can_be_taken) {
  write_flight();
  EXPECT_EQ(run_program("quality flight.aedat4 --max-exposure 5"), 2);
  expect_one_line("flight.aedat4: 0 frames compared, 4 left out: 1 too early, 3 exposed for too");
  EXPECT_NE(err.find("a --max-exposure over 5 ms takes those"), std::string::npos) << err;
  EXPECT_EQ(run_program("quality flight.aedat4 --until 0.01"), 2);
  expect_one_line("until_s = 0.01, allowed from_s (--from) = 0.05 to");
}

TEST_F(QualityCommandTest, is_silent_when_told_to) {
  write_flight();
  ASSERT_EQ(run_program("quality flight.aedat4 --method esi --quiet"), 0) << err;
  EXPECT_EQ(out + err, "");
}

TEST_F(QualityCommandTest, prints_json_of_the_methods_asked_for) {
  ASSERT_EQ(run_program("quality events.txt --reference frame.png --method htac --method esi "
                        "--json"),
            0)
      << err;
  const auto json = nlohmann::json::parse(out)["methods"];
  ASSERT_EQ(json.size(), 2u);
  EXPECT_EQ(json[0]["method"], "htac");
  EXPECT_NEAR(json[1]["ssim"], 1, 1e-9);  // two levels: the fit is exact
  EXPECT_TRUE(json[1]["psnr_db"].is_null() || json[1]["psnr_db"] > 200);
}

TEST_F(QualityCommandTest, refuses_what_it_cannot_compare) {
  EXPECT_EQ(run_program("quality events.txt"), 2);
  expect_one_line("events.txt: no frames to compare with; --reference PICTURE");
  EXPECT_EQ(run_program("quality events.txt --reference frame.png --from 1"), 2);
  expect_one_line("--reference excludes --from");
  EXPECT_EQ(run_program("quality events.txt --max-exposure 0"), 2);
  expect_one_line("max_exposure_ms = 0, allowed 0.001 to");
  EXPECT_EQ(run_program("quality events.txt --reference none.png"), 2);
  expect_one_line("none.png: cannot be read as a picture");
  scenarios::write_png(folder_ / "small.png", core::Image<std::uint8_t>({11, 11}));
  EXPECT_EQ(run_program("quality events.txt --reference small.png"), 2);
  expect_one_line("events.txt: events outside 11x11, the reference's size");
}

TEST_F(QualityCommandTest, runs_firenet_on_a_real_recording) {
  const auto data = test::data_folder();
  if (!data) GTEST_SKIP() << "no recordings";
  const fs::path base = fs::absolute(*data);
  const std::string name = (base / "davis240c_shapes_rotation").string();
  ASSERT_EQ(run_program("quality '" + name + ".txt' --reference '" + name +
                        "_aps.png' --method firenet --json --set 'reconstructor.firenet.weights=" +
                        (base / "firenet" / "firenet.onnx").string() + "'"),
            0)
      << err;
  const auto json = nlohmann::json::parse(out);
  EXPECT_GT(json["methods"][0]["ssim"], 0);
  EXPECT_LT(json["methods"][0]["ssim"], 1);
}

}  // namespace
}  // namespace nightjar::tools
