#pragma once

#include <filesystem>
#include <string>

namespace nightjar::scenarios {

/// The file `name`, which is meant from the folder `from`, as it is called from the folder `to`;
/// empty stays empty. A name that no file can have comes back behind `from`, for who opens it to
/// complain of.
std::string moved_name(const std::string& name, const std::filesystem::path& from,
                       const std::filesystem::path& to);

}  // namespace nightjar::scenarios
