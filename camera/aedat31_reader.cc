#include "camera/aedat31_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "camera/aedat_header.h"
#include "camera/caer_packets.h"
#include "camera/packet_compression.h"

namespace nightjar::camera {

Aedat31Reader::Aedat31Reader(ByteStream stream, std::optional<core::Resolution> size)
    : stream_(std::move(stream)) {
  AedatHeader header = read_aedat_header(stream_, kAedat31LastLine, size);
  camera_ = std::move(header.camera);
  intake_ = RecordingIntake(header.size);
}

bool Aedat31Reader::end_early(std::uint64_t begin, const std::string& why) {
  const std::uint64_t end = stream_.offset() + stream_.left();
  intake_.fault(&RecordingFaults::bytes_lost, why, end - begin);
  stream_.skip_to(end);
  return false;
}

bool Aedat31Reader::read_packet() {
  const std::uint64_t begin = stream_.offset();
  if (stream_.left() == 0) return false;
  intake_.set_place([this, begin] { return stream_.at(begin, "packet"); });
  if (stream_.left() < sizeof(header_)) return end_early(begin, "ends in its header");
  stream_.read(sizeof(header_), bytes_);
  header_ = little_endian<Aedat31PacketHeader>(bytes_, 0);
  const std::int64_t size = std::int64_t{header_.event_size} * header_.number;
  if (header_.event_size < 1 || header_.number < 0 || header_.overflow < 0 ||
      size > static_cast<std::int64_t>(kMostPacketBytes))
    return end_early(begin,
                     fmt::format("of {} events of {} bytes", header_.number, header_.event_size));
  const auto whole = static_cast<std::uint64_t>(size);
  const std::uint64_t there = std::min(
      whole, stream_.left() - stream_.left() % static_cast<std::uint64_t>(header_.event_size));
  stream_.read(there, bytes_);
  if (bytes_.size() < whole)
    end_early(stream_.offset(), fmt::format("of {} bytes, {} are left", whole, bytes_.size()));
  return true;
}

bool Aedat31Reader::next(RecordingPart& part) {
  part.clear();
  while (read_packet()) {
    decode(part);
    if (!part.empty()) return true;
  }
  return false;
}

void Aedat31Reader::decode(RecordingPart& part) {
  if (source_of_.emplace(header_.type, header_.source).first->second != header_.source) {
    intake_.fault(&RecordingFaults::packets_unknown,
                  fmt::format("of type {} from source {}", header_.type, header_.source));
    return;
  }
  decode_caer_events(header_, bytes_, intake_, part);
}

}  // namespace nightjar::camera
