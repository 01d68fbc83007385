#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "scenarios/gray_picture.h"
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
};

TEST_F(QualityCommandTest, prints_a_row_for_every_method) {
  ASSERT_EQ(run_program("quality events.txt --reference frame.png"), 0) << err;
  EXPECT_EQ(err, "");
  EXPECT_TRUE(out.starts_with("method ")) << out;
  for (const char* name : {"\nesi ", "\naccumulator ", "\ncomplementary_filter ", "\nhtac "})
    EXPECT_NE(out.find(name), std::string::npos) << name << out;
  EXPECT_NE(out.find("skipped: needs frames"), std::string::npos) << out;
  EXPECT_NE(out.find("skipped: no weights"), std::string::npos) << out;
}

TEST_F(QualityCommandTest, prints_json_of_the_methods_asked_for) {
  ASSERT_EQ(run_program("quality events.txt --reference frame.png --method htac --method esi "
                        "--json"),
            0)
      << err;
  const auto json = nlohmann::json::parse(out);
  ASSERT_EQ(json.size(), 2u);
  EXPECT_EQ(json[0]["method"], "htac");
  EXPECT_NEAR(json[1]["ssim"], 1, 1e-9);  // two levels: the fit is exact
  EXPECT_TRUE(json[1]["psnr_db"].is_null() || json[1]["psnr_db"] > 200);
}

TEST_F(QualityCommandTest, refuses_what_it_cannot_compare) {
  EXPECT_EQ(run_program("quality events.txt"), 2);
  expect_one_line("--reference is required");
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
  EXPECT_GT(json[0]["ssim"], 0);
  EXPECT_LT(json[0]["ssim"], 1);
}

}  // namespace
}  // namespace nightjar::tools
