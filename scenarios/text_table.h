#pragma once

#include <string>
#include <vector>

namespace nightjar::scenarios {

/// Rows of equally many cells, columns aligned on their left; no blanks at a line's end.
std::string text_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace nightjar::scenarios
