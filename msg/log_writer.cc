#include "msg/log_writer.h"

#include <fmt/format.h>

#include <stdexcept>

#include "msg/log_format.h"

namespace nightjar::msg {
namespace {

/// Most significant byte first.
template <class Unsigned>
void append(std::string& head, Unsigned value) {
  for (int shift = 8 * static_cast<int>(sizeof(value)) - 8; shift >= 0; shift -= 8)
    head += static_cast<char>(value >> shift);
}

}  // namespace

void LogWriter::write(const std::string& channel, std::span<const std::uint8_t> bytes) {
  if (finished_) return;
  if (channel.empty() || channel.size() > kMostChannelBytes || bytes.size() > kMostLogDataBytes)
    throw std::invalid_argument(
        fmt::format("log: {} bytes on a channel named with {}, allowed 0 to {} and 1 to {}",
                    bytes.size(), channel.size(), kMostLogDataBytes, kMostChannelBytes));
  std::string head;
  append(head, kLogMark);
  append(head, messages_++);
  append(head, static_cast<std::uint64_t>(message_time(bytes).count()));
  append(head, static_cast<std::uint32_t>(channel.size()));
  append(head, static_cast<std::uint32_t>(bytes.size()));
  file_.stream() << head << channel;
  file_.stream().write(reinterpret_cast<const char*>(bytes.data()),
                       static_cast<std::streamsize>(bytes.size()));
  file_.check();
}

void LogWriter::finish() {
  if (std::exchange(finished_, true)) return;
  file_.finish();
}

}  // namespace nightjar::msg
