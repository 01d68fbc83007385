#include "camera/recording_writer.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "camera/aedat31_writer.h"
#include "camera/aedat4_writer.h"
#include "camera/event_text.h"
#include "camera/recording_check.h"
#include "core/config_check.h"

namespace nightjar::camera {
namespace {

class TextRecordingWriter : public RecordingWriter {
 public:
  TextRecordingWriter(const std::filesystem::path& path, core::Resolution size)
      : file_(path), check_(size) {
    not_carried_.sensor = true;
  }

  void write(const RecordingPart& part) override {
    check_.check(part);
    file_.write(part.events);
    not_carried_.frames += part.frames.size();
    not_carried_.imu += part.imu.size();
    not_carried_.triggers += part.triggers.size();
  }

  void finish() override { file_.finish(); }

 private:
  EventTextWriter file_;
  RecordingCheck check_;
};

}  // namespace

std::vector<std::string> NotCarried::things() const {
  std::vector<std::string> things;
  const auto add = [&](std::uint64_t count, const char* what) {
    if (count > 0) things.push_back(fmt::format("{} {}", count, what));
  };
  if (sensor) things.push_back("the sensor's size and name");
  add(frames, "frames");
  add(imu, "IMU samples");
  add(triggers, "triggers");
  add(frames_rounded, "frames' bits beyond 8");
  add(imu_rounded, "IMU samples' digits beyond those of a float");
  return things;
}

void check_recording_name(const std::string& name, const std::filesystem::path& path) {
  const std::filesystem::path ending = path.extension();
  if (ending != ".aedat4" && ending != ".aedat" && ending != ".txt")
    throw std::invalid_argument(
        fmt::format("{} = {}, allowed a name ending in .aedat4, .aedat (AEDAT 3.1) or .txt", name,
                    path.string()));
}

std::unique_ptr<RecordingWriter> create_recording(const std::filesystem::path& path,
                                                  const RecordingHead& head,
                                                  Compression compression) {
  check_recording_name("recording", path);
  core::check_range("size.width_px", head.size.width_px, 1, core::kMostSide_px);
  core::check_range("size.height_px", head.size.height_px, 1, core::kMostSide_px);
  if (path.extension() == ".aedat4") return std::make_unique<Aedat4Writer>(path, head, compression);
  if (path.extension() == ".aedat") return std::make_unique<Aedat31Writer>(path, head);
  return std::make_unique<TextRecordingWriter>(path, head.size);
}

}  // namespace nightjar::camera
