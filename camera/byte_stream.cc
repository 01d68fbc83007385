#include "camera/byte_stream.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

namespace nightjar::camera {

ByteStream::ByteStream(std::unique_ptr<std::istream> in, std::string name)
    : in_(std::move(in)), name_(std::move(name)) {
  in_->seekg(0, std::ios::end);
  const std::streamoff length = in_->tellg();
  in_->seekg(0);
  if (!*in_ || length < 0) throw std::invalid_argument(fmt::format("{}: cannot be read", name_));
  length_ = static_cast<std::uint64_t>(length);
}

double ByteStream::progress() const {
  return length_ == 0 ? 1.0 : static_cast<double>(offset_) / static_cast<double>(length_);
}

void ByteStream::read(std::size_t count, std::vector<std::byte>& bytes) {
  bytes.resize(count);
  in_->read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(count));
  if (!*in_) throw std::invalid_argument(at(offset_, "cannot be read"));
  offset_ += count;
}

std::string ByteStream::read_line(std::size_t most) {
  const std::uint64_t begin = offset_;
  std::string line;
  for (char c = 0; c != '\n'; line += c) {
    if (!in_->get(c)) throw std::invalid_argument(at(begin, "no end of the line"));
    ++offset_;
    if (line.size() > most)
      throw std::invalid_argument(at(begin, fmt::format("a line of more than {} bytes", most)));
  }
  line.pop_back();
  if (line.ends_with('\r')) line.pop_back();
  return line;
}

int ByteStream::peek() { return left() == 0 ? -1 : in_->peek(); }

void ByteStream::skip_to(std::uint64_t offset) {
  offset_ = offset;
  in_->seekg(static_cast<std::streamoff>(offset));
}

std::string ByteStream::at(std::uint64_t offset, const std::string& why) const {
  return fmt::format("{}: byte {}: {}", name_, offset, why);
}

}  // namespace nightjar::camera
