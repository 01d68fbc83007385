#include "msg/log_writer.h"

#include <fmt/format.h>

#include <lcm/lcm-cpp.hpp>
#include <stdexcept>
#include <system_error>

#include "core/part_file.h"

namespace nightjar::msg {
namespace {

[[noreturn]] void throw_unwritten(const std::filesystem::path& path) {
  throw std::runtime_error(fmt::format("{}: cannot be written", path.string()));
}

}  // namespace

struct LogWriter::Impl {
  explicit Impl(std::filesystem::path log_path)
      : path(std::move(log_path)),
        part(core::part_name(path)),
        log(std::make_unique<lcm::LogFile>(part.string(), "w")) {}

  std::filesystem::path path;
  std::filesystem::path part;
  std::unique_ptr<lcm::LogFile> log;  // none once finished
};

LogWriter::LogWriter(std::filesystem::path path) : impl_(std::make_unique<Impl>(std::move(path))) {
  if (!impl_->log->good()) throw_unwritten(impl_->path);
}

LogWriter::~LogWriter() {
  if (!impl_->log) return;
  impl_->log.reset();
  std::error_code ignored;
  std::filesystem::remove(impl_->part, ignored);
}

void LogWriter::write(const std::string& channel, std::span<const std::uint8_t> bytes) {
  if (!impl_->log) return;
  lcm::LogEvent event{};
  event.timestamp = message_time(bytes).count();
  event.channel = channel;
  event.datalen = static_cast<std::int32_t>(bytes.size());
  event.data = const_cast<std::uint8_t*>(bytes.data());  // only read by LCM
  if (impl_->log->writeEvent(&event) != 0) throw_unwritten(impl_->path);
}

void LogWriter::finish() {
  if (!impl_->log) return;
  // The log's destructor closes the file without a word about failure.
  if (std::fflush(impl_->log->getFilePtr()) != 0) throw_unwritten(impl_->path);
  impl_->log.reset();
  std::error_code error;
  std::filesystem::rename(impl_->part, impl_->path, error);
  if (error) throw_unwritten(impl_->path);
}

}  // namespace nightjar::msg
