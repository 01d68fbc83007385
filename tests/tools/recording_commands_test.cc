// nightjar info, convert and view on recordings of every format.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "camera/recording_writer.h"
#include "msg/log_writer.h"
#include "tests/support/data_folder.h"
#include "tests/support/program.h"
#include "tests/support/recording_samples.h"

namespace nightjar::tools {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr core::Resolution kSize{37, 23};

// Runs the built program in a folder of its own that holds sample.aedat4, in Unix time.
class RecordingCommandsTest : public test::ProgramTest {
 protected:
  RecordingCommandsTest() {
    sample_ = test::sample_part(kSize, core::Time(1589163147368868));
    const auto writer = camera::create_recording(folder_ / "sample.aedat4", {kSize, "DAVIS"});
    writer->write(sample_);
    writer->finish();
  }

  json info(const std::string& file) {
    EXPECT_EQ(run_program("info " + file + " --json"), 0) << err;
    return json::parse(out);
  }

  void convert(const std::string& arguments) {
    ASSERT_EQ(run_program("convert " + arguments), 0) << err;
  }

  // What the reader in Python finds; nothing where there is no numpy for it.
  std::optional<json> read_independently(const std::string& file) {
    const std::string python = "/usr/bin/python3";
    if (std::system((python + " -c 'import numpy' 2>/dev/null").c_str()) != 0) return std::nullopt;
    const std::string command =
        fmt::format("cd '{}' && {} -B '{}/tests/support/read_recording.py' {} > read.json",
                    folder_.path().string(), python, NIGHTJAR_SOURCE_DIR, file);
    EXPECT_EQ(std::system(command.c_str()), 0);
    return json::parse(test::file_text(folder_ / "read.json"));
  }

  void expect_refused(const std::string& arguments, const std::string& part) {
    EXPECT_EQ(run_program(arguments), 2) << arguments << '\n' << err;
    expect_one_line(part);
  }

  camera::RecordingPart sample_;
};

TEST_F(RecordingCommandsTest, info_counts_what_is_in_a_recording) {
  const json found = info("sample.aedat4");
  EXPECT_EQ(found["format"], "AEDAT4");
  EXPECT_EQ(found["camera"], "DAVIS");
  EXPECT_EQ(found["width_px"], 37);
  EXPECT_EQ(found["events"]["count"], 5000);
  EXPECT_EQ(found["events"]["time"]["first_us"], sample_.events.front().t.count());
  EXPECT_EQ(found["events"]["time"]["last_us"], sample_.events.back().t.count());
  EXPECT_EQ(found["frames"]["count"], 3);
  EXPECT_EQ(found["frames"]["least_exposure_us"], 4000);
  EXPECT_EQ(found["frames"]["most_exposure_us"], 4002);
  EXPECT_EQ(found["imu"]["count"], 100);
  EXPECT_NEAR(found["imu"]["rate_hz"], 100, 1e-9);  // every 10 ms; rounding of a division
  EXPECT_EQ(found["triggers"], 10);
  EXPECT_EQ(found["faults"]["first"], "");
  ASSERT_EQ(run_program("info sample.aedat4"), 0);
  EXPECT_NE(out.find("37x23 px, DAVIS"), std::string::npos) << out;
  EXPECT_EQ(err, "");
}

TEST_F(RecordingCommandsTest, info_gives_the_known_counts_of_the_real_recording) {
  const auto folder = test::data_folder();
  if (!folder) GTEST_SKIP() << "no folder of recordings: set NIGHTJAR_DATA";
  const json road = info(fs::absolute(*folder / "davis346_road.aedat4").string());
  EXPECT_EQ(road["events"]["count"], 6676);
  EXPECT_EQ(road["events"]["on"], 3563);
  EXPECT_EQ(road["events"]["off"], 3113);
  EXPECT_EQ(road["events"]["time"]["first_us"], 1589163147368868);
  EXPECT_EQ(road["events"]["time"]["duration_s"], 0.169941);
  EXPECT_EQ(road["frames"]["count"], 4);
  EXPECT_EQ(road["imu"]["count"], 160);
  EXPECT_EQ(road["triggers"], 17);
}

TEST_F(RecordingCommandsTest, info_counts_the_faults_of_a_truncated_file) {
  fs::resize_file(folder_ / "sample.aedat4", fs::file_size(folder_ / "sample.aedat4") - 1);
  const json found = info("sample.aedat4");
  EXPECT_EQ(found["events"]["count"], 5000);
  EXPECT_EQ(found["triggers"], 0);
  EXPECT_GT(found["faults"]["bytes_lost"], 0);
  EXPECT_EQ(found["faults"]["first"].get<std::string>().find("sample.aedat4: byte "), 0u);
}

TEST_F(RecordingCommandsTest, an_independent_reader_finds_in_our_files_what_was_written) {
  const auto mine = read_independently("sample.aedat4");
  if (!mine) GTEST_SKIP() << "no numpy for /usr/bin/python3";
  EXPECT_EQ((*mine)["events"], 5000);
  EXPECT_EQ((*mine)["first_us"], sample_.events.front().t.count());
  EXPECT_EQ((*mine)["last_us"], sample_.events.back().t.count());
  ASSERT_EQ((*mine)["frames"].size(), 3u);
  EXPECT_EQ((*mine)["frames"][2]["shape"], (json{34, 18, 3, 5}));
  for (int i = 0; i < 10; ++i) EXPECT_EQ((*mine)["triggers"][i][1], i);  // AEDAT4's numbers
  convert("sample.aedat4 plain.aedat4 --compression none");
  EXPECT_EQ(*read_independently("plain.aedat4"), *mine);
  convert("sample.aedat4 a.aedat");
  json old = *read_independently("a.aedat");
  EXPECT_EQ(old["format"], "AEDAT 3.1");
  for (const char* key : {"events", "on", "first_us", "last_us", "checksum", "imu"})
    EXPECT_EQ(old[key], (*mine)[key]) << key;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(old["frames"][i]["times_us"], (*mine)["frames"][i]["times_us"]);
    EXPECT_EQ(old["frames"][i]["sum"], (*mine)["frames"][i]["sum"].get<int>() * 256);  // 16 bits
  }
  ASSERT_EQ(old["triggers"].size(), 10u);
  for (std::size_t i = 0; i < 10; ++i)  // libcaer's
    EXPECT_EQ(old["triggers"][i][1], sample_.triggers[i].type);
}

TEST_F(RecordingCommandsTest, an_independent_reader_finds_the_events_in_our_text) {
  const auto mine = read_independently("sample.aedat4");
  if (!mine) GTEST_SKIP() << "no numpy for /usr/bin/python3";
  convert("sample.aedat4 a.txt");
  const json text = *read_independently("a.txt");
  for (const char* key : {"events", "on", "first_us", "last_us", "checksum"})
    EXPECT_EQ(text[key], (*mine)[key]) << key;
}

TEST_F(RecordingCommandsTest, an_independent_reader_finds_in_our_logs_what_was_written) {
  const auto mine = read_independently("sample.aedat4");
  if (!mine) GTEST_SKIP() << "no numpy for /usr/bin/python3";
  convert("sample.aedat4 a.lcm");
  EXPECT_EQ(err, "");
  const json log = *read_independently("a.lcm");
  EXPECT_EQ(log["format"], "LCM log 37x23 DAVIS");
  for (const char* key : {"events", "on", "first_us", "last_us", "checksum", "frames"})
    EXPECT_EQ(log[key], (*mine)[key]) << key;
  ASSERT_EQ(log["imu"].size(), 100u);
  for (std::size_t i = 0; i < 100; ++i) {
    const camera::RecordedImu& sample = sample_.imu[i];
    const Eigen::Vector3d &f = sample.specific_force_camera_m_s2, &w = sample.omega_camera_rad_s;
    EXPECT_EQ(log["imu"][i], (json{sample.t.count(), sample.temperature_c, f.x(), f.y(), f.z(),
                                   w.x(), w.y(), w.z()}));
  }
  ASSERT_EQ(log["triggers"].size(), 10u);
  for (std::size_t i = 0; i < 10; ++i)
    EXPECT_EQ(log["triggers"][i], (json{sample_.triggers[i].t.count(), sample_.triggers[i].type}));
}

TEST_F(RecordingCommandsTest, recordings_come_through_a_log_as_they_were) {
  convert("sample.aedat4 a.lcm");
  json there = info("a.lcm"), here = info("sample.aedat4");
  EXPECT_EQ(there["format"], "LCM log");
  there["format"] = here["format"];
  EXPECT_EQ(there, here);
  convert("a.lcm again.aedat4");
  EXPECT_EQ(info("again.aedat4"), here);
  // The sample has its frames behind a whole second of events, so all has to be read first.
  for (const std::string file : {"a.lcm", "sample.aedat4"}) {
    ASSERT_EQ(run_program("view " + file + " --at 0.95 --span 0.02 --out " + file + ".png"), 0);
    ASSERT_EQ(run_program("reconstruct " + file + " --fps 10 --quiet --out " + file + ".d"), 0);
  }
  EXPECT_TRUE(test::file_text(folder_ / "a.lcm.png") ==
              test::file_text(folder_ / "sample.aedat4.png"));
  EXPECT_TRUE(test::file_text(folder_ / "a.lcm.d/picture_000005.png") ==
              test::file_text(folder_ / "sample.aedat4.d/picture_000005.png"));
}

TEST_F(RecordingCommandsTest, of_a_flights_log_the_rest_is_said_to_be_left_out) {
  {
    msg::LogWriter log(folder_ / "run.lcm");
    core::VehicleState state;
    log.write(msg::kVehicleState.name, msg::encode(state));
    using namespace std::chrono_literals;
    log.write(msg::kEvents.name, msg::encode(core::EventPacket{0ms, 9ms, {{1ms, 1, 1, true}}}));
    log.write(msg::kPicture.name,
              msg::encode(core::Picture{9ms, core::Image<std::uint8_t>({8, 6})}));
    log.write(msg::kPicture.name,
              msg::encode(core::Picture{19ms, core::Image<std::uint8_t>({8, 6})}));
    log.finish();
  }
  const json found = info("run.lcm");
  EXPECT_EQ(found["width_px"], 8);
  EXPECT_EQ(found["others"], (json{{"NIGHTJAR_PICTURE", 2}, {"NIGHTJAR_VEHICLE_STATE", 1}}));
  ASSERT_EQ(run_program("convert run.lcm a.aedat4"), 0) << err;
  EXPECT_EQ(err,
            "nightjar: warning: left out 2 messages NIGHTJAR_PICTURE\n"
            "nightjar: warning: left out 1 messages NIGHTJAR_VEHICLE_STATE\n");
}

TEST_F(RecordingCommandsTest, an_independent_reader_finds_the_same_in_the_real_recording) {
  const auto folder = test::data_folder();
  if (!folder) GTEST_SKIP() << "no folder of recordings: set NIGHTJAR_DATA";
  const std::string road = fs::absolute(*folder / "davis346_road.aedat4").string();
  const auto original = read_independently(road);
  if (!original) GTEST_SKIP() << "no numpy for /usr/bin/python3";
  EXPECT_EQ((*original)["events"], 6676);
  convert(road + " road.aedat");
  convert("road.aedat road.aedat4");
  EXPECT_EQ(*read_independently("road.aedat4"), *original);
  convert(road + " road.lcm");
  convert("road.lcm again.aedat4");
  EXPECT_EQ(*read_independently("again.aedat4"), *original);
}

TEST_F(RecordingCommandsTest, convert_says_what_it_leaves_out) {
  ASSERT_EQ(run_program("convert sample.aedat4 a.txt"), 0);
  EXPECT_EQ(err,
            "nightjar: warning: a.txt cannot carry the sensor's size and name\n"
            "nightjar: warning: a.txt cannot carry 3 frames\n"
            "nightjar: warning: a.txt cannot carry 100 IMU samples\n"
            "nightjar: warning: a.txt cannot carry 10 triggers\n");
  ASSERT_EQ(run_program("convert a.txt b.aedat4 --size 37x23 --compression zstd --quiet"), 0);
  EXPECT_EQ(out + err, "");
  EXPECT_EQ(info("b.aedat4")["events"], info("sample.aedat4")["events"]);
}

TEST_F(RecordingCommandsTest, view_draws_events_in_red_and_green_beside_the_last_frame) {
  ASSERT_EQ(run_program("view sample.aedat4 --at 0.5 --span 0.02 --out v.png"), 0) << err;
  const cv::Mat picture = cv::imread((folder_ / "v.png").string());
  ASSERT_EQ(picture.size(), cv::Size(2 * 37, 23));
  const core::Time begin = sample_.events.front().t + std::chrono::milliseconds(500);
  core::Event last{};
  for (const core::Event& event : sample_.events)
    if (event.t >= begin && event.t < begin + std::chrono::milliseconds(20)) last = event;
  EXPECT_EQ(picture.at<cv::Vec3b>(last.y, last.x),
            last.on ? cv::Vec3b(0, 200, 0) : cv::Vec3b(0, 0, 230));
  const int level = sample_.frames[1].gray(5, 6);  // exposed at 0.41 s, the next at 0.71 s
  EXPECT_EQ(picture.at<cv::Vec3b>(6, 37 + 5), cv::Vec3b::all(static_cast<std::uint8_t>(level)));
}

TEST_F(RecordingCommandsTest, view_draws_on_grey_where_there_is_no_frame) {
  std::ofstream(folder_ / "e.txt") << "0.5 1 2 1\n0.6 3 4 0\n";
  ASSERT_EQ(run_program("view e.txt --size 8x6 --at 0.05 --span 0.1 --out v.png"), 0) << err;
  EXPECT_EQ(out, "1 events, no frame before them\n");
  const cv::Mat picture = cv::imread((folder_ / "v.png").string());
  ASSERT_EQ(picture.size(), cv::Size(8, 6));
  EXPECT_EQ(picture.at<cv::Vec3b>(4, 3), cv::Vec3b(0, 0, 230));
  EXPECT_EQ(picture.at<cv::Vec3b>(2, 1), cv::Vec3b::all(96));
}

TEST_F(RecordingCommandsTest, bad_input_is_refused_in_one_line_and_leaves_no_file) {
  std::ofstream(folder_ / "empty.txt") << "# nothing\n";
  expect_refused("info none.aedat4", "none.aedat4: cannot be read");
  expect_refused("info .", "cannot be read");
  expect_refused("info sample.aedat4 --size 346x260", "says 37x23 px, expected 346x260");
  expect_refused("convert sample.aedat4 a.bag", "OUT = a.bag, allowed a name ending in .aedat4");
  expect_refused("convert sample.aedat4 a.aedat4 --compression gzip", "--compression = gzip");
  expect_refused("convert sample.aedat4 none/a.txt", "none/a.txt: cannot be written");
  expect_refused("view sample.aedat4 --at 99 --out v.png", "at = 99 s, allowed 0 to ");
  expect_refused("view sample.aedat4 --at -1 --out v.png", "at = -1, allowed 0 to");
  expect_refused("view sample.aedat4 --at 0 --span 0 --out v.png", "span = 0, allowed");
  expect_refused("view sample.aedat4 --at 0 --out v.jpg", "--out = v.jpg, allowed");
  expect_refused("view empty.txt --at 0 --out v.png", "no events");
  for (const auto& entry : fs::directory_iterator(folder_.path())) {
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(name == "sample.aedat4" || name == "empty.txt" || name.ends_with(".log")) << name;
  }
}

TEST_F(RecordingCommandsTest, emulated_events_and_sensor_reports_know_aedat) {
  fs::create_directory(folder_ / "frames");
  for (int i = 0; i < 10; ++i) {
    cv::Mat frame(16, 16, CV_8U, cv::Scalar(50));
    frame.col(i) = 200;
    ASSERT_TRUE(cv::imwrite((folder_ / fmt::format("frames/{}.pgm", i)).string(), frame));
  }
  const std::string emulate = "emulate frames --fps 500 --preset clean --quiet --out ";
  ASSERT_EQ(run_program(emulate + "e.txt"), 0) << err;
  ASSERT_EQ(run_program(emulate + "e.aedat4"), 0) << err;
  const json found = info("e.aedat4");
  EXPECT_EQ(found["width_px"], 16);
  ASSERT_EQ(run_program("convert e.aedat4 again.txt --quiet"), 0) << err;
  EXPECT_EQ(test::file_text(folder_ / "again.txt"), test::file_text(folder_ / "e.txt"));
  ASSERT_EQ(run_program("sensor-report --duration 0.1 --preset clean --size 16x16 --json "
                        "--recording e.aedat4"),
            0)
      << err;
  EXPECT_EQ(json::parse(out)["columns"].size(), 3u);
}

}  // namespace
}  // namespace nightjar::tools
