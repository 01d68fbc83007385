#include "msg/log_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace nightjar::msg {
namespace {

constexpr std::string_view kMark("\xed\xa1\xda\x01");  // kLogMark
constexpr std::size_t kMarkBytes = 4;
constexpr std::size_t kBlockBytes = 65536;

/// Most significant byte first.
std::uint32_t u32(const char* bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < sizeof(value); ++i)
    value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

std::unique_ptr<std::istream> open_file(const std::filesystem::path& path) {
  auto in = std::make_unique<std::ifstream>(path, std::ios::binary);
  std::error_code ignored;
  if (!*in || !std::filesystem::is_regular_file(path, ignored))
    throw std::invalid_argument(fmt::format("{}: cannot be read", path.string()));
  return in;
}

}  // namespace

LogReader::LogReader(const std::filesystem::path& path)
    : LogReader(open_file(path), path.string()) {}

LogReader::LogReader(std::unique_ptr<std::istream> in, std::string name)
    : in_(std::move(in)), name_(std::move(name)) {
  in_->seekg(0, std::ios::end);
  const std::streamoff length = in_->tellg();
  in_->seekg(0);
  if (!*in_ || length < 0) throw std::invalid_argument(fmt::format("{}: cannot be read", name_));
  length_ = static_cast<std::uint64_t>(length);
}

void LogReader::read_file(std::uint64_t at, std::size_t count, char* to) {
  in_->seekg(static_cast<std::streamoff>(at));
  in_->read(to, static_cast<std::streamsize>(count));
  if (!*in_) throw std::invalid_argument(fmt::format("{}: byte {}: cannot be read", name_, at));
}

/// `count` bytes from `at` on, if the file has them.
bool LogReader::read(std::uint64_t at, std::size_t count, char* to) {
  if (at + count > length_) return false;
  if (at >= block_begin_ && at + count <= block_begin_ + block_.size())
    std::copy_n(block_.data() + (at - block_begin_), count, to);
  else
    read_file(at, count, to);
  return true;
}

/// The block's bytes from `at` on: a mark's at least, which the file must have there.
std::string_view LogReader::block_from(std::uint64_t at) {
  if (at < block_begin_ || at + kMarkBytes > block_begin_ + block_.size()) {
    block_.resize(std::min<std::uint64_t>(kBlockBytes, length_ - at));
    block_begin_ = at;
    read_file(at, block_.size(), block_.data());
  }
  return std::string_view(block_).substr(at - block_begin_);
}

/// Goes on to the next mark from `next_` on, counting what lies before it.
bool LogReader::find_mark() {
  for (begin_ = next_; begin_ + kMarkBytes <= length_;) {
    const std::string_view block = block_from(begin_);
    const std::size_t at = block.find(kMark);
    begin_ += at != block.npos ? at : block.size() - (kMarkBytes - 1);
    if (at == block.npos) continue;
    lost_ += begin_ - next_;
    return true;
  }
  lost_ += length_ - next_;
  begin_ = next_ = length_;
  return false;
}

/// Of the message whose mark is at `begin_`, if it can be one: behind it the next message
/// begins, or the file ends.
std::optional<LogReader::Head> LogReader::read_head() {
  std::array<char, kLogHeadBytes> bytes;
  if (!read(begin_, bytes.size(), bytes.data())) return std::nullopt;
  const Head head{u32(bytes.data() + 20), u32(bytes.data() + 24)};
  if (head.channel_bytes < 1 || head.channel_bytes > kMostChannelBytes ||
      head.data_bytes > kMostLogDataBytes)
    return std::nullopt;
  const std::uint64_t end = begin_ + kLogHeadBytes + head.channel_bytes + head.data_bytes;
  if (end > length_) return std::nullopt;
  std::array<char, kMarkBytes> four;
  const bool another = read(end, four.size(), four.data());
  if (another && u32(four.data()) != kLogMark) return std::nullopt;
  return head;
}

std::optional<Message> LogReader::next() {
  while (find_mark()) {
    const auto head = read_head();
    if (!head) {
      lost_ += kMarkBytes;
      next_ = begin_ + kMarkBytes;
      continue;
    }
    Message message;
    message.channel.resize(head->channel_bytes);
    message.bytes.resize(head->data_bytes);
    read(begin_ + kLogHeadBytes, head->channel_bytes, message.channel.data());
    next_ = begin_ + kLogHeadBytes + head->channel_bytes;
    read(next_, head->data_bytes, reinterpret_cast<char*>(message.bytes.data()));
    next_ += head->data_bytes;
    return message;
  }
  return std::nullopt;
}

double LogReader::progress() const {
  return length_ == 0 ? 1.0 : static_cast<double>(next_) / static_cast<double>(length_);
}

bool is_log(const std::filesystem::path& path) {
  std::array<char, kMarkBytes> begin{};
  std::ifstream file(path, std::ios::binary);
  return file.read(begin.data(), begin.size()) && u32(begin.data()) == kLogMark;
}

}  // namespace nightjar::msg
