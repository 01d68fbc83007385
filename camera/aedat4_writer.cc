#include "camera/aedat4_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "camera/aedat4_reader.h"
#include "camera/gray_level.h"
#include "camera/imu_axes.h"
#include "camera/info_xml.h"
#include "camera/trigger_types.h"
#include "nightjar_flatbuffers/aedat4_generated.h"

namespace nightjar::camera {
namespace {

enum Stream { kEvents, kFrames, kImu, kTriggers };

/// A stream as the header describes it.
struct Description {
  const char* kind;
  const char* name;
  const char* text;
};

constexpr std::array<Description, 4> kStreams = {{
    {"EVTS", "events", "Array of events (polarity ON/OFF)."},
    {"FRME", "frames", "Standard frame (8-bit image)."},
    {"IMUS", "imu", "Inertial Measurement Unit data samples."},
    {"TRIG", "triggers", "External triggers and special signals."},
}};

constexpr std::array kCompressionNames = {"NONE", "LZ4", "LZ4_HIGH", "ZSTD", "ZSTD_HIGH"};

constexpr std::size_t kMostPerPacket = 1 << 18;  // of 16 bytes: 4 MiB

std::string attribute(const char* key, const char* type, const std::string& value) {
  return fmt::format("<attr key=\"{}\" type=\"{}\">{}</attr>\n", key, type, escaped_xml(value));
}

std::string info_xml(const RecordingHead& head, Compression compression) {
  std::string xml = "<dv version=\"2.0\">\n<node name=\"outInfo\" path=\"/outInfo/\">\n";
  for (std::size_t i = 0; i < kStreams.size(); ++i) {
    xml += fmt::format("<node name=\"{0}\" path=\"/outInfo/{0}/\">\n", i);
    xml += attribute("compression", "string",
                     kCompressionNames[static_cast<std::size_t>(compression)]);
    xml += attribute("originalModuleName", "string", "nightjar");
    xml += attribute("originalOutputName", "string", kStreams[i].name);
    xml += attribute("typeDescription", "string", kStreams[i].text);
    xml += attribute("typeIdentifier", "string", kStreams[i].kind);
    xml += fmt::format("<node name=\"info\" path=\"/outInfo/{}/info/\">\n", i);
    xml += attribute("sizeX", "int", std::to_string(head.size.width_px));
    xml += attribute("sizeY", "int", std::to_string(head.size.height_px));
    xml += attribute("source", "string", head.camera);
    xml += attribute("tsOffset", "long", "0") + "</node>\n</node>\n";
  }
  return xml + "</node>\n</dv>\n";
}

std::span<const std::byte> bytes_of(const flatbuffers::FlatBufferBuilder& builder) {
  return std::as_bytes(std::span(builder.GetBufferPointer(), builder.GetSize()));
}

}  // namespace

Aedat4Writer::Aedat4Writer(const std::filesystem::path& path, const RecordingHead& head,
                           Compression compression)
    : compression_(compression), check_(head.size), file_(path) {
  write_header(head);
}

void Aedat4Writer::write_header(const RecordingHead& head) {
  flatbuffers::FlatBufferBuilder builder;
  const auto info = builder.CreateString(info_xml(head, compression_));
  constexpr std::int64_t kNoTable = -1;
  builder.FinishSizePrefixed(
      aedat4::CreateHeader(builder, static_cast<std::int32_t>(compression_), kNoTable, info),
      "IOHE");
  file_.stream() << kAedat4FirstLine << "\r\n";
  file_.stream().write(reinterpret_cast<const char*>(builder.GetBufferPointer()),
                       static_cast<std::streamsize>(builder.GetSize()));
  file_.check();
}

void Aedat4Writer::write(const RecordingPart& part) {
  check_.check(part);
  for (std::span<const core::Event> rest = part.events; !rest.empty();) {
    const std::size_t count = std::min(rest.size(), kMostPerPacket);
    write_events(rest.first(count));
    rest = rest.subspan(count);
  }
  for (const RecordedFrame& frame : part.frames) write_frame(frame);
  for (std::span<const RecordedImu> rest = part.imu; !rest.empty();) {
    const std::size_t count = std::min(rest.size(), kMostPerPacket);
    write_imu(rest.first(count));
    rest = rest.subspan(count);
  }
  for (std::span<const Trigger> rest = part.triggers; !rest.empty();) {
    const std::size_t count = std::min(rest.size(), kMostPerPacket);
    write_triggers(rest.first(count));
    rest = rest.subspan(count);
  }
}

void Aedat4Writer::write_events(std::span<const core::Event> events) {
  flatbuffers::FlatBufferBuilder builder;
  aedat4::Event* written = nullptr;
  const auto vector = builder.CreateUninitializedVectorOfStructs(events.size(), &written);
  for (const core::Event& event : events)
    *written++ = aedat4::Event(event.t.count(), static_cast<std::int16_t>(event.x),
                               static_cast<std::int16_t>(event.y), event.on);
  builder.FinishSizePrefixed(aedat4::CreateEventPacket(builder, vector), "EVTS");
  write_packet(kEvents, bytes_of(builder));
}

void Aedat4Writer::write_frame(const RecordedFrame& frame) {
  constexpr int kBits = 8;
  constexpr std::int8_t kGray = 0;
  if (frame.bits > kBits) ++not_carried_.frames_rounded;
  const core::Image<std::uint16_t> gray = with_bits(frame.gray, frame.bits, kBits);
  flatbuffers::FlatBufferBuilder builder;
  std::uint8_t* level = nullptr;
  const auto pixels = builder.CreateUninitializedVector(gray.pixels().size(), &level);
  for (const std::uint16_t each : gray.pixels()) *level++ = static_cast<std::uint8_t>(each);
  const core::Time middle = frame.exposure_begin + (frame.exposure_end - frame.exposure_begin) / 2;
  builder.FinishSizePrefixed(
      aedat4::CreateFrame(
          builder, middle.count(), frame.frame_begin.count(), frame.frame_end.count(),
          frame.exposure_begin.count(), frame.exposure_end.count(), kGray,
          static_cast<std::int16_t>(gray.width()), static_cast<std::int16_t>(gray.height()),
          static_cast<std::int16_t>(frame.left_px), static_cast<std::int16_t>(frame.top_px),
          pixels),
      "FRME");
  write_packet(kFrames, bytes_of(builder));
}

void Aedat4Writer::write_imu(std::span<const RecordedImu> samples) {
  flatbuffers::FlatBufferBuilder builder;
  std::vector<flatbuffers::Offset<aedat4::Imu>> written;
  written.reserve(samples.size());
  for (const RecordedImu& sample : samples) {
    const RawImu raw = from_camera_axes(sample);
    if (!fits_floats(sample)) ++not_carried_.imu_rounded;
    written.push_back(aedat4::CreateImu(builder, sample.t.count(), sample.temperature_c,
                                        raw.acceleration_g[0], raw.acceleration_g[1],
                                        raw.acceleration_g[2], raw.rate_deg_s[0], raw.rate_deg_s[1],
                                        raw.rate_deg_s[2]));
  }
  builder.FinishSizePrefixed(aedat4::CreateImuPacket(builder, builder.CreateVector(written)),
                             "IMUS");
  write_packet(kImu, bytes_of(builder));
}

void Aedat4Writer::write_triggers(std::span<const Trigger> triggers) {
  flatbuffers::FlatBufferBuilder builder;
  std::vector<flatbuffers::Offset<aedat4::Trigger>> written;
  for (const Trigger& trigger : triggers) {
    const auto type = trigger_to_aedat4(trigger.type);
    if (type)
      written.push_back(
          aedat4::CreateTrigger(builder, trigger.t.count(), static_cast<std::int8_t>(*type)));
    else
      ++not_carried_.triggers;
  }
  if (written.empty()) return;
  builder.FinishSizePrefixed(aedat4::CreateTriggerPacket(builder, builder.CreateVector(written)),
                             "TRIG");
  write_packet(kTriggers, bytes_of(builder));
}

void Aedat4Writer::write_packet(int stream, std::span<const std::byte> plain) {
  const std::vector<std::byte> packed = compress(plain, compression_);
  const std::array<std::int32_t, 2> header = {stream, static_cast<std::int32_t>(packed.size())};
  file_.stream().write(reinterpret_cast<const char*>(header.data()), sizeof(header));
  file_.stream().write(reinterpret_cast<const char*>(packed.data()),
                       static_cast<std::streamsize>(packed.size()));
  file_.check();
}

}  // namespace nightjar::camera
