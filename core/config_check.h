#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace nightjar::core {

/// The names an enumeration has in a scenario file.
template <class Enum, std::size_t N>
using Choices = std::array<std::pair<const char*, Enum>, N>;

/// Where a parameter's default comes from; an assumption of ours begins with
/// "assumption:". `unit` only where the name's ending does not tell it; kPureNumber
/// for what has none. Shown by the parameter table, no matter to the other visitors.
struct Origin {
  const char* source = "";
  const char* unit = "";
};

inline constexpr const char* kPureNumber = "1";

/// A number as people write it: no trailing zeros.
std::string number_text(double value);

/// Throws std::invalid_argument "path = value, allowed least to greatest" when a
/// value, a NaN among them, is out of range.
void check_range(const std::string& path, double value, double least, double greatest);

/// A config struct declares its members once, in
///     template <class Visitor> void visit(Visitor& v);
/// and every visitor offers the calls below, each with a last argument `Origin` that
/// may be left out. This one checks the ranges.
class RangeCheck {
 public:
  explicit RangeCheck(std::string path) : path_(std::move(path)) {}

  void field(const char* name, const double& value, double least, double greatest,
             const Origin& = {}) {
    check_range(at(name), value, least, greatest);
  }
  void field(const char* name, const int& value, int least, int greatest, const Origin& = {}) {
    check_range(at(name), value, least, greatest);
  }
  /// Every element has the same range.
  template <std::size_t N>
  void field(const char* name, const std::array<double, N>& value, double least, double greatest,
             const Origin& = {}) {
    for (std::size_t i = 0; i < N; ++i)
      check_range(at(name) + '[' + std::to_string(i) + ']', value[i], least, greatest);
  }
  void field(const char*, const bool&, const Origin& = {}) {}
  void field(const char*, const std::string&, const Origin& = {}) {}

  template <class Enum, std::size_t N>
  void choice(const char*, const Enum&, const Choices<Enum, N>&, const Origin& = {}) {}

  template <class Config>
  void section(const char* name, Config& config) {
    RangeCheck inner(at(name));
    config.visit(inner);
  }

  /// Between `least` and `greatest` sections of one kind.
  template <class Config>
  void list(const char* name, std::vector<Config>& configs, std::size_t least,
            std::size_t greatest) {
    check_range(at(name) + ".size", static_cast<double>(configs.size()), static_cast<double>(least),
                static_cast<double>(greatest));
    for (std::size_t i = 0; i < configs.size(); ++i)
      section((std::string(name) + '[' + std::to_string(i) + ']').c_str(), configs[i]);
  }

 private:
  std::string at(const std::string& name) const {
    return path_.empty() ? name : path_ + '.' + name;
  }

  std::string path_;
};

/// Throws std::invalid_argument naming the first member out of range.
template <class Config>
void check_config(const Config& config, const std::string& path) {
  RangeCheck check(path);
  Config copy = config;  // visit() also serves readers, so it is not const
  copy.visit(check);
}

}  // namespace nightjar::core
