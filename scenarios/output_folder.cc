#include "scenarios/output_folder.h"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include "core/part_file.h"

namespace nightjar::scenarios {
namespace {

// The summary first: a folder being cleared never looks complete.
constexpr std::array kResultFiles{kSummaryFile, kScenarioFile, kEstimatesFile, kLogFile,
                                  kVideoFile};

[[noreturn]] void throw_unusable(const std::filesystem::path& folder, const std::string& why) {
  throw std::invalid_argument(fmt::format("output folder {}: {}", folder.string(), why));
}

void remove_old(const std::filesystem::path& file) {
  std::error_code error;
  std::filesystem::remove(file, error);
  if (error)
    throw_unusable(file.parent_path(), fmt::format("old {} cannot be removed, {}",
                                                   file.filename().string(), error.message()));
}

// Permissions do not tell all (read-only mounts, full disks), an attempt does.
void check_writable(const std::filesystem::path& folder, const std::filesystem::path& probe) {
  std::ofstream out(probe);
  out << '\n' << std::flush;
  if (!out) throw_unusable(folder, "cannot be written");
  out.close();
  std::filesystem::remove(probe);
}

}  // namespace

bool create_output_folder(const std::filesystem::path& folder) {
  std::error_code error;
  const bool is_new = std::filesystem::create_directories(folder, error);
  std::error_code ignored;
  if (std::filesystem::is_directory(folder, ignored)) return is_new;
  if (std::filesystem::exists(folder, ignored)) throw_unusable(folder, "is a file");
  throw_unusable(folder, "cannot be created, " + error.message());
}

OutputFolder::OutputFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
  create_output_folder(folder_);
  check_writable(folder_, part(kSummaryFile));
  for (const std::string_view name : kResultFiles) {
    remove_old(path(name));
    remove_old(part(name));
  }
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  for (const std::string_view name : kResultFiles) std::filesystem::remove(part(name), ignored);
}

std::filesystem::path OutputFolder::path(std::string_view name) const { return folder_ / name; }

std::filesystem::path OutputFolder::part(std::string_view name) const {
  return core::part_name(path(name));
}

void OutputFolder::complete(std::string_view name) {
  if (name == kSummaryFile) check_all_complete();
  std::error_code error;
  std::filesystem::rename(part(name), path(name), error);
  if (error)
    throw std::runtime_error(
        fmt::format("{}: cannot be written, {}", path(name).string(), error.message()));
}

void OutputFolder::write(std::string_view name, std::string_view text) {
  std::ofstream out(part(name), std::ios::binary);
  out << text << std::flush;
  if (!out) throw std::runtime_error(fmt::format("{}: cannot be written", path(name).string()));
  out.close();
  complete(name);
}

void OutputFolder::check_all_complete() const {
  for (const std::string_view name : kResultFiles)
    if (name != kSummaryFile && std::filesystem::exists(part(name)))
      throw std::runtime_error(
          fmt::format("{}: not complete when the summary came", path(name).string()));
}

}  // namespace nightjar::scenarios
