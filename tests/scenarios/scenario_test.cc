#include "scenarios/scenario.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "scenarios/corner_inset.h"
#include "scenarios/yaml_writer.h"

namespace nightjar::scenarios {
namespace {

namespace fs = std::filesystem;

// A folder of its own with a model in it.
class ScenarioTest : public testing::Test {
 protected:
  ScenarioTest() {
    fs::create_directories(folder_ / "models");
    std::ofstream(folder_ / "models" / "arena.xml") << "<mujoco/>";
  }
  ~ScenarioTest() override { fs::remove_all(folder_); }

  fs::path write(const std::string& text) const {
    const fs::path path = folder_ / "dark.yaml";
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }

  static std::string read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  // What load() says about a file with `text`, without the folder.
  std::string complaint(const std::string& text) const {
    try {
      load(write(text));
    } catch (const ScenarioError& error) {
      return std::string(error.what()).substr(folder_.string().size() + 1);
    }
    return "no complaint";
  }

  fs::path folder_ = fs::temp_directory_path() / ("nightjar_scenario_" + std::to_string(getpid()));
};

TEST_F(ScenarioTest, FindsTheModelBesideTheFile) {
  const Scenario scenario = load(write("model: models/arena.xml\nseed: 5\n"));
  EXPECT_EQ(scenario.seed, 5);
  EXPECT_TRUE(fs::equivalent(scenario.model, folder_ / "models" / "arena.xml"));
}

TEST_F(ScenarioTest, RefusesEveryBadFileOfTheIssueInOneLine) {
  const std::string model = "model: models/arena.xml\n";
  EXPECT_EQ(complaint(model + "ilumination: 5\n").substr(0, 66),
            "dark.yaml:2:1: ilumination: unknown key, nearest is illuminance_lu");
  EXPECT_EQ(complaint(model + "illuminance_lux: bright\n"),
            "dark.yaml:2:1: illuminance_lux = bright, expected a number from 0.1 to 100000");
  EXPECT_EQ(complaint(model + "illuminance_lux: -5\n"),
            "dark.yaml:2:1: illuminance_lux = -5, allowed 0.1 to 100000");
  EXPECT_EQ(complaint("seed: 1\nmodel: models/none.xml\n"),
            "dark.yaml:2:1: model = models/none.xml, no such file");
  EXPECT_EQ(complaint("model: models\n"), "dark.yaml:1:1: model = models, no such file");
  EXPECT_EQ(complaint("seed: 1\n"), "dark.yaml: model is not set, expected an MJCF file");
  EXPECT_EQ(complaint(""), "dark.yaml:1:1: the file is empty");
  EXPECT_EQ(complaint(model + "seed: 5000000000\n"),
            "dark.yaml:2:1: seed = 5000000000, allowed 0 to 2147483647");
}

TEST_F(ScenarioTest, SaysWhichFileIsMissing) {
  try {
    load(folder_ / "none.yaml");
    FAIL() << "no complaint";
  } catch (const ScenarioError& error) {
    EXPECT_EQ(error.what(), (folder_ / "none.yaml").string() + ": no such file");
  }
}

TEST_F(ScenarioTest, NamesAFileWholeHoweverLongItsPath) {
  const fs::path path = folder_ / std::string(100, 'd') / "none\n.yaml";
  try {
    load(path);
    FAIL() << "no complaint";
  } catch (const ScenarioError& error) {
    EXPECT_EQ(error.what(), path.parent_path().string() + "/none?.yaml: no such file");
  }
  const std::string model = std::string(100, 'm') + "/none.xml";
  EXPECT_EQ(complaint("model: " + model + "\n"),
            "dark.yaml:1:1: model = " + model + ", no such file");
}

TEST_F(ScenarioTest, RefusesValuesThatDoNotFitEachOther) {
  const std::string model = "model: models/arena.xml\n";
  EXPECT_EQ(complaint(model + "world: {ugv: {course: [{x_m: 0}, {x_m: 1}, {x_m: 1}]}}\n"),
            "dark.yaml: world.ugv.course[2] lies on its predecessor, allowed at least 0.001 m "
            "apart");
  EXPECT_EQ(complaint(model + "sensor: {preset: custom, pixel: {log_linear_below: 2.7}}\n"),
            "dark.yaml: sensor.pixel.log_linear_below = 2.7, allowed 0, or 2.72 to 128");
  EXPECT_EQ(complaint(model + "sensor: {aps: {exposure_ms: 2, interval_ms: 4}}\n"),
            "dark.yaml: sensor.aps.interval_ms = 4 with an exposure of 2 ms "
            "(sensor.aps.exposure_ms), allowed one of them at least "
            "world.renderer.max_interval_ms = 5");
}

TEST_F(ScenarioTest, TakesFramesAsFastAsTheWorldIsDrawn) {
  const std::string model = "model: models/arena.xml\n";
  EXPECT_EQ(complaint(model + "sensor: {aps: {exposure_ms: 2, interval_ms: 5}}\n"), "no complaint");
  EXPECT_EQ(complaint(model + "sensor: {aps: {exposure_ms: 5, interval_ms: 4}}\n"), "no complaint");
  // 5 lux want 0.5 s of exposure, 5000 lux 1 ms.
  EXPECT_EQ(complaint(model + "sensor: {aps: {interval_ms: 4}}\n"), "no complaint");
  EXPECT_NE(complaint(model + "illuminance_lux: 5000\nsensor: {aps: {interval_ms: 4}}\n"),
            "no complaint");
}

TEST_F(ScenarioTest, TakesTheMethodsCornerInsetUnlessTheFileSaysIt) {
  const auto inset_px = [&](const std::string& text) {
    return load(write("model: models/arena.xml\n" + text)).tracker.measurement.corner_inset_px;
  };
  EXPECT_EQ(inset_px(""), corner_inset_px(esi::Method::esi));
  EXPECT_EQ(inset_px("reconstructor: {method: esi_net}\n"), corner_inset_px(esi::Method::esi_net));
  EXPECT_EQ(inset_px("tracker: {measurement: {corner_noise_px: 1}}\n"
                     "reconstructor: {method: esi_net}\n"),
            corner_inset_px(esi::Method::esi_net));
  EXPECT_EQ(inset_px("reconstructor: {method: esi_net}\n"
                     "tracker: {measurement: {corner_inset_px: 0.4}}\n"),
            0.4);
}

TEST_F(ScenarioTest, ReadsBackWhatItSavedAnywhere) {
  Scenario scenario = load(write("model: models/arena.xml\nname: \"a: b\"\nduration_s: 0.1\n"));
  scenario.illuminance_lux = 1.0 / 3.0;
  scenario.world.ugv.course.push_back({1, 2, 0.1, sim::CoursePhase::landing});
  fs::create_directories(folder_ / "out" / "deep");
  const fs::path path = folder_ / "out" / "deep" / "scenario.yaml";
  save(scenario, path);
  EXPECT_EQ(to_yaml(load(path)), to_yaml(scenario));
}

TEST_F(ScenarioTest, SavesThePixelsOfACustomSensor) {
  Scenario scenario = load(write("model: models/arena.xml\nsensor: {preset: custom}\n"));
  scenario.sensor.pixel.cutoff_hz = 123.456;
  save(scenario, folder_ / "scenario.yaml");
  EXPECT_EQ(load(folder_ / "scenario.yaml").sensor.pixel.cutoff_hz, 123.456);
}

TEST_F(ScenarioTest, SavesThePixelsThatAPresetStandsForAsAComment) {
  const std::string model = "model: models/arena.xml\nilluminance_lux: 2\n";
  const Scenario scenario = load(write(model));
  save(scenario, folder_ / "saved.yaml");
  const std::string text = read(folder_ / "saved.yaml");
  EXPECT_NE(text.find("\n#   cutoff_hz: 12  # 0 to 100000\n"), std::string::npos) << text;
  EXPECT_EQ(to_yaml(load(folder_ / "saved.yaml")), to_yaml(scenario));

  // Uncommented, it is the custom sensor that runs alike.
  std::string custom = model + "sensor:\n  preset: custom\n  pixel:\n";
  std::istringstream lines(text.substr(text.find("#   threshold_on_log")));
  for (std::string line; std::getline(lines, line);) custom += "    " + line.substr(4) + '\n';
  const Scenario same = load(write(custom));
  EXPECT_EQ(to_yaml(sim::effective_pixel(same.sensor, 2)),
            to_yaml(sim::effective_pixel(scenario.sensor, 2)));
  save(same, folder_ / "custom.yaml");
  EXPECT_EQ(read(folder_ / "custom.yaml").find("#   "), std::string::npos);
}

TEST_F(ScenarioTest, SaysWhenItCannotSave) {
  const Scenario scenario = load(write("model: models/arena.xml\n"));
  EXPECT_THROW(save(scenario, folder_ / "none" / "scenario.yaml"), ScenarioError);
  EXPECT_THROW(save(scenario, "/dev/full"), ScenarioError);  // a disk without room
}

TEST_F(ScenarioTest, ChecksAScenarioMadeInCode) {
  Scenario scenario = load(write("model: models/arena.xml\n"));
  EXPECT_NO_THROW(check(scenario));
  scenario.illuminance_lux = 0;
  EXPECT_THROW(check(scenario), ScenarioError);
}

// A visitor that collects every number of a scenario with its range.
class Collector {
 public:
  struct Number {
    std::function<void(double)> set;
    double value, least, greatest;
    bool whole;
    std::string path;
  };

  void field(const char* name, double& value, double least, double greatest,
             const core::Origin& = {}) {
    numbers.push_back(
        {[&value](double v) { value = v; }, value, least, greatest, false, path + name});
  }
  void field(const char* name, int& value, int least, int greatest, const core::Origin& = {}) {
    const auto set = [&value](double v) { value = static_cast<int>(v); };
    numbers.push_back({set, static_cast<double>(value), static_cast<double>(least),
                       static_cast<double>(greatest), true, path + name});
  }
  template <std::size_t N>
  void field(const char* name, std::array<double, N>& values, double least, double greatest,
             const core::Origin& = {}) {
    for (double& value : values) field(name, value, least, greatest);
  }
  void field(const char*, bool&, const core::Origin& = {}) {}
  void field(const char*, std::string&, const core::Origin& = {}) {}
  template <class Enum, std::size_t N>
  void choice(const char*, Enum&, const core::Choices<Enum, N>&, const core::Origin& = {}) {}
  template <class Config>
  void section(const char* name, Config& config) {
    const std::string outer = path;
    path += std::string(name) + '.';
    config.visit(*this);
    path = outer;
  }
  template <class Config>
  void list(const char* name, std::vector<Config>& configs, std::size_t, std::size_t) {
    for (Config& config : configs) section(name, config);
  }

  std::vector<Number> numbers;
  std::string path;
};

TEST_F(ScenarioTest, TakesEveryNumberAtItsEndsAndRefusesItJustOutside) {
  Scenario scenario = load(write("model: models/arena.xml\nsensor: {preset: custom}\n"));
  const fs::path path = folder_ / "dark.yaml";
  Collector collector;
  scenario.visit(collector);
  ASSERT_GT(collector.numbers.size(), 50u);
  const auto text_with = [&](const Collector::Number& number, double value) {
    number.set(value);
    Scenario copy = scenario;
    copy.model = "models/arena.xml";
    // A simulated camera sits where the model says.
    if (number.path.starts_with("source.mount")) copy.source.type = camera::SourceType::caer;
    number.set(number.value);
    return to_yaml(copy);
  };
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const Collector::Number& number : collector.numbers) {
    EXPECT_NO_THROW(parse(text_with(number, number.least), path)) << number.path;
    EXPECT_NO_THROW(parse(text_with(number, number.greatest), path)) << number.path;
    if (number.whole && number.greatest == std::numeric_limits<int>::max()) continue;
    const double below = number.whole ? number.least - 1 : std::nextafter(number.least, -kInfinity);
    const double above =
        number.whole ? number.greatest + 1 : std::nextafter(number.greatest, kInfinity);
    EXPECT_THROW(parse(text_with(number, below), path), ScenarioError) << number.path;
    EXPECT_THROW(parse(text_with(number, above), path), ScenarioError) << number.path;
  }
}

TEST(ShippedScenarios, AllLoad) {
  int count = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(NIGHTJAR_SOURCE_DIR) / "scenarios")) {
    if (entry.path().extension() != ".yaml") continue;
    EXPECT_NO_THROW(load(entry.path())) << entry.path();
    ++count;
  }
  EXPECT_GT(count, 0);
}

}  // namespace
}  // namespace nightjar::scenarios
