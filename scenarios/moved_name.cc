#include "scenarios/moved_name.h"

#include <system_error>

namespace nightjar::scenarios {

std::string moved_name(const std::string& name, const std::filesystem::path& from,
                       const std::filesystem::path& to) {
  if (name.empty()) return name;
  std::error_code error;
  const std::filesystem::path moved = std::filesystem::proximate(from / name, to, error);
  return (error ? from / name : moved).string();
}

}  // namespace nightjar::scenarios
