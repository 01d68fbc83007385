#pragma once

#include <string>

namespace nightjar::scenarios {

/// What gnuplot draws for `script`, which sets a terminal but no output: the bytes of
/// the picture. The user's own settings are left aside.
/// Throws std::runtime_error when there is no such program or it refuses the script.
std::string run_gnuplot(const std::string& script);

/// `text` as a string of gnuplot's that means just these characters, in one line.
std::string gnuplot_text(const std::string& text);

}  // namespace nightjar::scenarios
