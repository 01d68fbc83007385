#pragma once

#include <cstdint>
#include <istream>
#include <string>

#include "core/event.h"

namespace nightjar::camera {

/// The events of a text, line by line: see read_event_text() for the format.
class EventTextLines {
 public:
  static constexpr std::size_t kMostLineBytes = 65536;

  /// Reads `in`, which has to outlive this; `name` stands for the file in errors. Throws
  /// std::invalid_argument for a `limit` that is empty or over 32767 a side.
  EventTextLines(std::istream& in, std::string name, core::Resolution limit);

  /// The next event, false at the end. Throws std::invalid_argument "FILE:line: ..." for a
  /// line that is none or lies outside the limit; after that, reading can go on behind it.
  bool next(core::Event& event);

  /// "FILE:line" of the last event or error.
  std::string place() const;

  std::uint64_t bytes_read() const { return bytes_; }

  /// The length of the line of the last event or error, if it is the file's last and has no
  /// line end; else 0.
  std::uint64_t bytes_of_cut_line() const { return ended_ ? 0 : text_.size(); }

 private:
  bool read_line();

  std::istream& in_;
  std::string name_;
  core::Resolution limit_;
  std::string text_;
  std::size_t line_ = 0;
  std::uint64_t bytes_ = 0;
  bool ended_ = true;
};

}  // namespace nightjar::camera
