#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "camera/event_text.h"
#include "scenarios/gray_picture.h"
#include "tests/support/data_folder.h"
#include "tests/support/program.h"
#include "tracker/tag_image.h"

namespace nightjar::tools {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr core::Resolution kSensor{120, 120};
constexpr int kTagId = 7, kAt_px = 20, kCell_px = 8;
/// As real cameras stamp.
constexpr core::Time kEpoch{1589163147368868};

/// Three events a pixel that draw a tag's white and black within 30 ms.
void write_tag_events(const fs::path& path) {
  const core::Image<std::uint8_t> tag = tracker::tag_image(kTagId, kCell_px);
  camera::EventTextWriter out(path);
  for (int i = 0; i < 3; ++i) {
    std::vector<core::Event> events;
    for (int y = 0; y < tag.height(); ++y)
      for (int x = 0; x < tag.width(); ++x)
        events.push_back({kEpoch + i * 15ms, static_cast<std::uint16_t>(kAt_px + x),
                          static_cast<std::uint16_t>(kAt_px + y), tag(x, y) > 127});
    out.write(events);
  }
  out.finish();
}

class ReconstructCommandTest : public test::ProgramTest {
 protected:
  ReconstructCommandTest() { write_tag_events(folder_ / "events.txt"); }

  int run(const std::string& arguments) { return run_program("reconstruct " + arguments); }

  // Bad input: exit 2, one line that holds `part`, and no folder.
  void expect_refused(const std::string& arguments, const std::string& part) {
    EXPECT_EQ(run(arguments), 2) << arguments << '\n' << err;
    expect_one_line(part);
    EXPECT_FALSE(fs::exists(folder_ / "out"));
  }

  std::string read(const std::string& name) const { return test::file_text(folder_ / name); }
};

TEST_F(ReconstructCommandTest, names_the_methods_one_a_line) {
  ASSERT_EQ(run("--list-methods"), 0) << err;
  EXPECT_TRUE(out.starts_with("esi\n")) << out;
  for (const char* name :
       {"accumulator", "complementary_filter", "edi", "fedi", "htac", "firenet", "e2vid"})
    EXPECT_NE(out.find(fmt::format("\n{}\n", name)), std::string::npos) << name;
}

TEST_F(ReconstructCommandTest, writes_pictures_and_every_tag_in_them) {
  ASSERT_EQ(run("events.txt --size 120x120 --method esi --fps 100 --out out --tags 36h11"), 0)
      << err;
  EXPECT_EQ(err, "");
  EXPECT_NE(out.find("3 in 3 of 3 pictures (100.0 %)"), std::string::npos) << out;
  EXPECT_EQ(read("out/times.csv"),
            "picture,time_us\n1,1589163147378868\n2,1589163147388868\n3,1589163147398868\n");
  const auto picture = scenarios::read_gray_picture(folder_ / "out/picture_000003.png");
  EXPECT_EQ(picture.size(), kSensor);
  EXPECT_EQ(picture(0, 0), 128);

  const std::string text = read("out/tags.csv");
  std::istringstream tags(text);
  std::string header, row;
  std::getline(tags, header);
  EXPECT_EQ(header, "time_us,id,hamming,decision_margin,corners_px");
  std::getline(tags, row);
  EXPECT_TRUE(row.starts_with("1589163147378868,7,0,")) << row;
  // The black square is 8 of 10 cells; bottom left, bottom right, top right, top left.
  const double low = kAt_px + kCell_px - 0.5, high = kAt_px + 9 * kCell_px - 0.5;
  std::istringstream corners(row.substr(row.rfind(',') + 1));
  for (const double wanted : {low, high, high, high, high, low, low, low}) {
    double got = 0;
    ASSERT_TRUE(corners >> got);
    EXPECT_NEAR(got, wanted, 1.0);  // the median filter rounds corners
  }
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 4);
  EXPECT_EQ(nlohmann::json::parse(read("out/summary.json"))["pictures_with_tag"], 3);
}

TEST_F(ReconstructCommandTest, writes_the_same_bytes_again) {
  for (const char* name : {"a", "b"})
    ASSERT_EQ(run(fmt::format("events.txt --out {} --tags 36h11 --quiet", name)), 0) << err;
  EXPECT_EQ(out + err, "");
  for (const char* name : {"picture_000003.png", "times.csv", "tags.csv"})
    EXPECT_EQ(read(std::string("a/") + name), read(std::string("b/") + name)) << name;
}

TEST_F(ReconstructCommandTest, takes_parameters_from_a_file_and_the_command_line) {
  std::ofstream(folder_ / "a.yaml")
      << "reconstructor: {method: accumulator, esi: {contrast_log: 1}}\n";
  ASSERT_EQ(run("events.txt --config a.yaml --json"), 0) << err;
  EXPECT_EQ(nlohmann::json::parse(out)["method"], "accumulator");
  ASSERT_EQ(run("events.txt --config a.yaml --method esi --out out --quiet"), 0) << err;
  const auto strong = scenarios::read_gray_picture(folder_ / "out/picture_000001.png");
  ASSERT_EQ(run("events.txt --config a.yaml --method esi --out out --quiet "
                "--set reconstructor.esi.contrast_log=0.1"),
            0)
      << err;
  const auto weak = scenarios::read_gray_picture(folder_ / "out/picture_000001.png");
  EXPECT_EQ(strong(22, 22), 255);  // the white border
  EXPECT_LT(weak(22, 22), 160);
  fs::remove_all(folder_ / "out");
  expect_refused("events.txt --set reconstructor.esi.contrast_log=9", "contrast_log = 9, allowed");
  expect_refused("events.txt --config none.yaml", "none.yaml");
}

TEST_F(ReconstructCommandTest, writes_a_video) {
  ASSERT_EQ(run("events.txt --video --out out --fps 200"), 0) << err;
  EXPECT_TRUE(fs::exists(folder_ / "out/pictures.mp4"));
  EXPECT_FALSE(fs::exists(folder_ / "out/picture_000001.png"));
}

TEST_F(ReconstructCommandTest, scores_the_last_picture) {
  ASSERT_EQ(run("events.txt --size 120x120 --out out --quiet"), 0) << err;
  fs::rename(folder_ / "out/picture_000003.png", folder_ / "reference.png");
  ASSERT_EQ(run("events.txt --size 120x120 --score reference.png --json"), 0) << err;
  EXPECT_NEAR(nlohmann::json::parse(out)["score"]["ssim"], 1, 1e-9);
  fs::remove_all(folder_ / "out");
  expect_refused("events.txt --size 121x120 --score reference.png", "picture of 121x120 px");
  expect_refused("events.txt --score events.txt", "cannot be read as a picture");
}

TEST_F(ReconstructCommandTest, warns_where_no_picture_was_due) {
  ASSERT_EQ(run("events.txt --fps 1 --quiet"), 0);
  EXPECT_NE(err.find("no picture was due"), std::string::npos) << err;
}

TEST_F(ReconstructCommandTest, asks_for_a_networks_weights) {
  expect_refused("events.txt --method firenet --out out",
                 "firenet needs weights: reconstructor.firenet.weights = FILE.onnx");
  expect_refused("events.txt --method e2vid --weights events.txt --out out",
                 "events.txt: is no ONNX network");
  expect_refused("events.txt --weights events.txt --out out",
                 "--weights only matters with --method firenet or e2vid");
}

TEST_F(ReconstructCommandTest, refuses_options_that_make_no_sense) {
  expect_refused("", "which RECORDING?");
  expect_refused("none.txt --out out", "none.txt");
  expect_refused("events.txt --method magic --out out", "--method = magic, allowed esi, ");
  expect_refused("events.txt --tags 16h5 --out out", "--tags = 16h5, allowed 36h11");
  expect_refused("events.txt --fps 0 --out out", "fps = 0, allowed 0.01 to 100000");
  expect_refused("events.txt --fps nan --out out", "fps = nan");
  expect_refused("events.txt --from -1 --out out", "from_s = -1");
  expect_refused("events.txt --video", "--video needs --out");
  expect_refused("events.txt --size 12 --out out", "--size = 12");
  std::ofstream(folder_ / "empty.txt") << "# nothing\n";
  expect_refused("empty.txt --size 20x20 --out out", "empty.txt: no events");
  std::ofstream(folder_ / "file") << "mine";
  expect_refused("events.txt --out file", "output folder file: is a file");
}

TEST_F(ReconstructCommandTest, leaves_nothing_when_it_is_interrupted) {
  // A hundred thousand pictures a second: the signal comes while they are written.
  EXPECT_EQ(
      test::interrupt_when_there_is(folder_ / "out/picture_000002.png",
                                    {"reconstruct", (folder_ / "events.txt").string(), "--fps",
                                     "100000", "--out", (folder_ / "out").string(), "--quiet"}),
      130);
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(ReconstructCommandTest, reads_a_real_cameras_recording) {
  const auto data = test::data_folder();
  if (!data) GTEST_SKIP() << "no recordings";
  const std::string file =
      fmt::format("'{}'", fs::absolute(*data / "davis346_road.aedat4").string());
  ASSERT_EQ(run(file + " --method complementary_filter --json"), 0) << err;
  const auto json = nlohmann::json::parse(out);
  EXPECT_EQ(json["events"], 6676);
  EXPECT_EQ(json["begin_us"], 1589163147368868);
  EXPECT_EQ(json["width_px"], 346);
  EXPECT_EQ(json["pictures"], 16);  // 169.941 ms
  EXPECT_GT(json["frames"], 0);
}

TEST_F(ReconstructCommandTest, explains_itself) {
  EXPECT_EQ(run("--help"), 0);
  EXPECT_EQ(err, "");
  EXPECT_NE(out.find("Examples:"), std::string::npos);
}

}  // namespace
}  // namespace nightjar::tools
