#include "core/part_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

namespace nightjar::core {
namespace {

/// Creates an empty file beside `path`, under a name that was free.
std::filesystem::path create_part(const std::filesystem::path& path) {
  for (int i = 1;; ++i) {
    std::filesystem::path part = part_name(path);
    if (i > 1)
      part = path.parent_path() /
             fmt::format("{}.part{}{}", path.stem().string(), i, path.extension().string());
    // "x": fails where the file exists, whoever else creates it at the same moment.
    if (std::FILE* file = std::fopen(part.c_str(), "wbx")) {
      std::fclose(file);
      return part;
    }
    if (errno != EEXIST)
      throw std::invalid_argument(fmt::format("{}: cannot be written, {}", path.string(),
                                              std::generic_category().message(errno)));
  }
}

}  // namespace

std::filesystem::path part_name(std::filesystem::path path) {
  const std::string extension = path.extension().string();
  return path.replace_extension(".part" + extension);
}

PartFile::PartFile(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code ignored;
  if (std::filesystem::exists(path_, ignored) && !std::filesystem::is_regular_file(path_, ignored))
    throw std::invalid_argument(fmt::format("{}: is not a plain file", path_.string()));
  part_ = create_part(path_);
  out_.open(part_, std::ios::binary);
}

PartFile::~PartFile() {
  if (part_.empty()) return;
  out_.close();
  std::error_code ignored;
  std::filesystem::remove(part_, ignored);
}

void PartFile::check() const {
  if (!out_) throw std::runtime_error(fmt::format("{}: cannot be written", path_.string()));
}

void PartFile::finish() {
  out_.close();
  check();
  std::error_code error;
  std::filesystem::rename(part_, path_, error);
  if (error)
    throw std::runtime_error(
        fmt::format("{}: cannot be written, {}", path_.string(), error.message()));
  part_.clear();
}

}  // namespace nightjar::core
