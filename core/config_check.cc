#include "core/config_check.h"

#include <fmt/format.h>

namespace nightjar::core {

std::string number_text(double value) { return fmt::format("{:.10g}", value); }

void check_range(const std::string& path, double value, double least, double greatest) {
  if (value >= least && value <= greatest) return;
  throw std::invalid_argument(fmt::format("{} = {}, allowed {} to {}", path, number_text(value),
                                          number_text(least), number_text(greatest)));
}

}  // namespace nightjar::core
