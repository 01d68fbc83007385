#include "camera/aedat4_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "camera/gray_level.h"
#include "camera/imu_axes.h"
#include "camera/info_xml.h"
#include "camera/printable_text.h"
#include "camera/trigger_types.h"
#include "nightjar_flatbuffers/aedat4_generated.h"

namespace nightjar::camera {
namespace {

constexpr std::size_t kMostHeaderBytes = std::size_t{1} << 20;
constexpr std::size_t kMostNameLength = 100;
constexpr std::size_t kPrefixBytes = 4;  // of a flatbuffer: its size
constexpr std::size_t kPacketHeaderBytes = 8;
constexpr int kMostNesting = 8;
constexpr int kMostTables = 1'000'000;  // IMU samples or triggers in a packet

const std::uint8_t* raw(const std::vector<std::byte>& bytes) {
  return reinterpret_cast<const std::uint8_t*>(bytes.data());
}

/// The table that size-prefixed `bytes` hold. Writers align its numbers either from the
/// prefix on or from behind it; for the latter the prefix is cut off, so that the numbers
/// come to lie where a processor wants them. Throws std::invalid_argument when it is no
/// such table.
template <class Table>
const Table& verified(std::vector<std::byte>& bytes, const char* identifier) {
  flatbuffers::Verifier whole(raw(bytes), bytes.size(), kMostNesting, kMostTables);
  if (whole.VerifySizePrefixedBuffer<Table>(identifier))
    return *flatbuffers::GetSizePrefixedRoot<Table>(bytes.data());
  const bool size_fits = bytes.size() >= kPrefixBytes &&
                         little_endian<std::uint32_t>(bytes, 0) == bytes.size() - kPrefixBytes;
  if (size_fits) bytes.erase(bytes.begin(), bytes.begin() + kPrefixBytes);
  flatbuffers::Verifier body(raw(bytes), bytes.size(), kMostNesting, kMostTables);
  if (!size_fits || !body.VerifyBuffer<Table>(identifier))
    throw std::invalid_argument(fmt::format("is no table {}", identifier));
  return *flatbuffers::GetRoot<Table>(bytes.data());
}

/// The four letters that say what a size-prefixed flatbuffer holds.
std::string identifier_of(const std::vector<std::byte>& bytes) {
  constexpr std::size_t kAt = 8, kLength = 4;
  if (bytes.size() < kAt + kLength) throw std::invalid_argument("is too small for a table");
  return {reinterpret_cast<const char*>(bytes.data()) + kAt, kLength};
}

std::optional<int> int_of(const std::map<std::string, std::string>& info, const std::string& key) {
  const auto found = info.find(key);
  if (found == info.end()) return std::nullopt;
  const std::string& text = found->second;
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::string text_of(const std::map<std::string, std::string>& info, const std::string& key) {
  const auto found = info.find(key);
  return found == info.end() ? std::string() : found->second;
}

/// OpenCV's numbers of 8-bit pictures with 1, 3 and 4 channels; 0 for others.
std::size_t channels_of(int format) {
  switch (format) {
    case 0: return 1;
    case 16: return 3;
    case 24: return 4;
    default: return 0;
  }
}

std::uint16_t gray_of(const std::uint8_t* pixel, std::size_t channels) {
  return channels == 1 ? *pixel : gray_level(pixel[2], pixel[1], pixel[0]);
}

}  // namespace

Aedat4Reader::Aedat4Reader(ByteStream stream, std::optional<core::Resolution> size)
    : stream_(std::move(stream)), intake_({}) {
  read_header(size);
}

void Aedat4Reader::read_header(std::optional<core::Resolution> size) {
  stream_.read_line(std::strlen(kAedat4FirstLine) + 2);
  const std::uint64_t begin = stream_.offset();
  const auto fail = [&](const std::string& why) {
    throw std::invalid_argument(stream_.at(begin, "the header " + why));
  };
  if (stream_.left() < kPrefixBytes) fail("is missing");
  std::vector<std::byte> bytes;
  stream_.read(kPrefixBytes, bytes);
  const auto length = little_endian<std::uint32_t>(bytes, 0);
  if (length > kMostHeaderBytes || length > stream_.left())
    fail(fmt::format("has {} bytes, allowed {}", length,
                     std::min<std::uint64_t>(kMostHeaderBytes, stream_.left())));
  stream_.skip_to(begin);
  stream_.read(kPrefixBytes + length, bytes);
  try {
    const auto& header = verified<aedat4::Header>(bytes, "IOHE");
    if (header.compression() < 0 || header.compression() > 4)
      fail(fmt::format("says compression = {}, allowed 0 to 4", header.compression()));
    compression_ = static_cast<Compression>(header.compression());
    read_streams(header.info() == nullptr ? "" : header.info()->str(), size);
    end_ = stream_.offset() + stream_.left();
    const std::int64_t table = header.table_position();
    intake_.set_place([this, begin] { return stream_.at(begin, "the header"); });
    if (table >= 0 && static_cast<std::uint64_t>(table) > end_)
      intake_.fault(&RecordingFaults::bytes_lost,
                    fmt::format("names a table at {}, the file has {} bytes", table, end_), 0);
    else if (table >= static_cast<std::int64_t>(stream_.offset()))
      end_ = static_cast<std::uint64_t>(table);
  } catch (const std::invalid_argument& error) {
    if (std::string_view(error.what()).starts_with(stream_.name())) throw;
    fail(error.what());
  }
}

void Aedat4Reader::read_streams(const std::string& xml, std::optional<core::Resolution> size) {
  const auto info = read_info_xml(xml);
  core::Resolution told;
  for (const auto& [key, kind] : info) {
    constexpr std::string_view kBefore = "outInfo/", kBehind = "/typeIdentifier";
    if (!key.starts_with(kBefore) || !key.ends_with(kBehind) ||
        key.size() <= kBefore.size() + kBehind.size())
      continue;
    const std::string node = key.substr(0, key.size() - kBehind.size());
    const auto stream = int_of({{"", node.substr(kBefore.size())}}, "");
    if (!stream) continue;
    const auto [chosen, is_new] = stream_of_.emplace(kind, *stream);
    chosen->second = std::min(chosen->second, *stream);
    const core::Resolution each{int_of(info, node + "/info/sizeX").value_or(0),
                                int_of(info, node + "/info/sizeY").value_or(0)};
    if (each.width_px > 0 && (kind == "EVTS" || told == core::Resolution{})) told = each;
    if (camera_.empty())
      camera_ = printable_text(text_of(info, node + "/info/source"), kMostNameLength);
  }
  if (told == core::Resolution{} && !size)
    throw std::invalid_argument("does not tell the sensor's size: it has to be given");
  if (told == core::Resolution{}) told = *size;
  if (size && *size != told)
    throw std::invalid_argument(fmt::format("says {}x{} px, expected {}x{}", told.width_px,
                                            told.height_px, size->width_px, size->height_px));
  if (std::min(told.width_px, told.height_px) < 1 ||
      std::max(told.width_px, told.height_px) > core::kMostSide_px)
    throw std::invalid_argument(fmt::format("says {}x{} px, allowed 1 to {} a side", told.width_px,
                                            told.height_px, core::kMostSide_px));
  intake_ = RecordingIntake(told);
}

std::optional<Aedat4Reader::Packet> Aedat4Reader::end_early(const std::string& why) {
  intake_.fault(&RecordingFaults::bytes_lost, why, end_ - stream_.offset());
  stream_.skip_to(end_);
  return std::nullopt;
}

std::optional<Aedat4Reader::Packet> Aedat4Reader::read_packet() {
  Packet packet{stream_.offset(), 0};
  const std::uint64_t left = end_ - packet.offset;
  if (left == 0) return std::nullopt;
  intake_.set_place([this, packet] { return stream_.at(packet.offset, "packet"); });
  if (left < kPacketHeaderBytes) return end_early("ends in its header");
  stream_.read(kPacketHeaderBytes, packed_);
  packet.stream = little_endian<std::int32_t>(packed_, 0);
  const auto length = little_endian<std::int32_t>(packed_, 4);
  const bool too_long = length > static_cast<std::int64_t>(left - kPacketHeaderBytes);
  if (length < 0 || too_long || static_cast<std::size_t>(length) > kMostPacketBytes) {
    stream_.skip_to(packet.offset);
    return end_early(fmt::format("of {} bytes, {} are left", length, left - kPacketHeaderBytes));
  }
  stream_.read(static_cast<std::size_t>(length), packed_);
  return packet;
}

bool Aedat4Reader::next(RecordingPart& part) {
  part.clear();
  while (const auto packet = read_packet()) {
    try {
      decode(*packet, part);
    } catch (const std::invalid_argument& error) {
      intake_.fault(&RecordingFaults::packets_damaged, error.what());
    }
    if (!part.empty()) return true;
  }
  return false;
}

void Aedat4Reader::decode(const Packet& packet, RecordingPart& part) {
  decompress(packed_, compression_, bytes_);
  const std::string kind = identifier_of(bytes_);
  const bool known = kind == "EVTS" || kind == "FRME" || kind == "IMUS" || kind == "TRIG";
  if (!known || stream_of_.emplace(kind, packet.stream).first->second != packet.stream) {
    intake_.fault(&RecordingFaults::packets_unknown,
                  known ? fmt::format("of a second stream of {}", kind) : "of an unknown type");
    return;
  }
  if (kind == "EVTS") decode_events(part);
  if (kind == "FRME") decode_frame(part);
  if (kind == "IMUS") decode_imu(part);
  if (kind == "TRIG") decode_triggers(part);
}

void Aedat4Reader::decode_events(RecordingPart& part) {
  const auto* events = verified<aedat4::EventPacket>(bytes_, "EVTS").events();
  if (events == nullptr) return;
  part.events.reserve(events->size());
  for (flatbuffers::uoffset_t i = 0; i < events->size(); ++i) {
    aedat4::Event event;  // copied, for the verifier does not see that structs are aligned
    std::memcpy(&event, events->Data() + i * sizeof(event), sizeof(event));
    intake_.add({core::Time(event.t_us()), static_cast<std::uint16_t>(event.x()),
                 static_cast<std::uint16_t>(event.y()), event.on()},
                part);
  }
}

void Aedat4Reader::decode_frame(RecordingPart& part) {
  const auto& frame = verified<aedat4::Frame>(bytes_, "FRME");
  const std::size_t channels = channels_of(frame.format());
  if (channels == 0) throw std::invalid_argument(fmt::format("frame of format {}", frame.format()));
  const core::Resolution size{frame.width_px(), frame.height_px()};
  const std::size_t pixels = frame.pixels() == nullptr ? 0 : frame.pixels()->size();
  if (size.width_px < 1 || size.height_px < 1 ||
      pixels != channels * static_cast<std::size_t>(size.pixels()))
    throw std::invalid_argument(
        fmt::format("frame of {}x{} with {} bytes", size.width_px, size.height_px, pixels));
  RecordedFrame recorded;
  // Newer writers leave all but the middle out.
  const bool middle_alone = frame.exposure_end_us() == 0 && frame.t_us() != 0;
  const auto time_of = [&](std::int64_t us) {
    return core::Time(middle_alone ? frame.t_us() : us);
  };
  recorded.exposure_begin = time_of(frame.exposure_begin_us());
  recorded.exposure_end = time_of(frame.exposure_end_us());
  recorded.frame_begin = time_of(frame.begin_us());
  recorded.frame_end = time_of(frame.end_us());
  recorded.left_px = frame.left_px();
  recorded.top_px = frame.top_px();
  recorded.gray = core::Image<std::uint16_t>(size);
  const std::uint8_t* pixel = frame.pixels()->data();
  for (std::uint16_t& gray : recorded.gray.pixels()) {
    gray = gray_of(pixel, channels);
    pixel += channels;
  }
  intake_.add(std::move(recorded), part);
}

void Aedat4Reader::decode_imu(RecordingPart& part) {
  const auto* samples = verified<aedat4::ImuPacket>(bytes_, "IMUS").samples();
  if (samples == nullptr) return;
  for (const aedat4::Imu* imu : *samples) {
    const RawImu raw{{imu->acceleration_x_g(), imu->acceleration_y_g(), imu->acceleration_z_g()},
                     {imu->rate_x_deg_s(), imu->rate_y_deg_s(), imu->rate_z_deg_s()}};
    intake_.add(to_camera_axes(core::Time(imu->t_us()), raw, imu->temperature_c()), part);
  }
}

void Aedat4Reader::decode_triggers(RecordingPart& part) {
  const auto* triggers = verified<aedat4::TriggerPacket>(bytes_, "TRIG").triggers();
  if (triggers == nullptr) return;
  for (const aedat4::Trigger* trigger : *triggers) {
    const auto type = trigger_from_aedat4(trigger->type());
    if (!type) {
      intake_.fault(&RecordingFaults::packets_unknown,
                    fmt::format("trigger of type {}", trigger->type()));
      continue;
    }
    if (*type == kTimestampReset) intake_.expect_reset();
    intake_.add(Trigger{core::Time(trigger->t_us()), *type}, part);
  }
}

}  // namespace nightjar::camera
