#pragma once

#include <fmt/format.h>

#include <iterator>
#include <string>
#include <utility>

namespace nightjar::scenarios {

/// A script that grows line by line.
class GnuplotScript {
 public:
  template <class... Args>
  void line(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_.push_back('\n');
  }
  std::string text() const { return fmt::to_string(text_); }

 private:
  fmt::memory_buffer text_;
};

/// What gnuplot draws for `script`, which sets a terminal but no output: the bytes of
/// the picture. The user's own settings are left aside.
/// Throws std::runtime_error when there is no such program or it refuses the script.
std::string run_gnuplot(const std::string& script);

/// `text` as a string of gnuplot's that means just these characters, in one line.
std::string gnuplot_text(const std::string& text);

}  // namespace nightjar::scenarios
