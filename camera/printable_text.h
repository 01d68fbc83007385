#pragma once

#include <string>
#include <string_view>

namespace nightjar::camera {

/// What a file says as an error or a table may show it: printable ASCII, ? for other bytes,
/// cut after `most`.
std::string printable_text(std::string_view text, std::size_t most = 40);

}  // namespace nightjar::camera
