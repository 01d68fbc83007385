#include "msg/log_reader.h"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <lcm/lcm-cpp.hpp>
#include <stdexcept>
#include <system_error>

namespace nightjar::msg {

struct LogReader::Impl {
  explicit Impl(const std::filesystem::path& path) : log(path.string(), "r") {}

  lcm::LogFile log;
  std::uintmax_t size_bytes = 0;
};

LogReader::LogReader(std::filesystem::path path) : impl_(std::make_unique<Impl>(path)) {
  std::error_code error;
  impl_->size_bytes = std::filesystem::file_size(path, error);
  if (!impl_->log.good() || error)
    throw std::invalid_argument(fmt::format("{}: cannot be read", path.string()));
}

LogReader::~LogReader() = default;

std::optional<Message> LogReader::next() {
  const lcm::LogEvent* event = impl_->log.readNextEvent();
  if (!event) return std::nullopt;
  const auto* data = static_cast<const std::uint8_t*>(event->data);
  return Message{event->channel, Bytes(data, data + event->datalen)};
}

double LogReader::progress() const {
  const long at = std::ftell(impl_->log.getFilePtr());
  if (at < 0 || impl_->size_bytes == 0) return 1;
  return static_cast<double>(at) / static_cast<double>(impl_->size_bytes);
}

bool is_log(const std::filesystem::path& path) {
  constexpr std::array<char, 4> kMagic = {'\xed', '\xa1', '\xda', '\x01'};  // lcm eventlog.c
  std::array<char, 4> begin{};
  std::ifstream file(path, std::ios::binary);
  return file.read(begin.data(), begin.size()) && begin == kMagic;
}

}  // namespace nightjar::msg
