#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/choice_text.h"

namespace nightjar::scenarios {

/// One parameter of a scenario file. Ranges include both ends.
struct Parameter {
  std::string path;  ///< Dotted name; `[]` stands for an index into a list.
  std::string default_value;
  std::string allowed;  ///< "0 to 1000", "true, false", or the names of a choice.
  /// "m/s"; "1" for a pure number, "-" for what is no number, empty where not stated.
  std::string unit;
  std::string source;  ///< Of the default (core::Origin); empty where not stated.
};

/// A visitor (core/config_check.h) that lists the members of a config struct in
/// the order of their declaration, as they stand in the visited struct.
class ParameterTable {
 public:
  explicit ParameterTable(std::string path = "") : path_(std::move(path)) {}

  void field(const char* name, const double& value, double least, double greatest,
             const core::Origin& origin = {});
  void field(const char* name, const int& value, int least, int greatest,
             const core::Origin& origin = {});
  void field(const char* name, const bool& value, const core::Origin& origin = {});
  void field(const char* name, const std::string& value, const core::Origin& origin = {});
  template <std::size_t N>
  void field(const char* name, const std::array<double, N>& value, double least, double greatest,
             const core::Origin& origin = {}) {
    add_numbers(name, {value.begin(), value.end()}, least, greatest, origin);
  }

  template <class Enum, std::size_t N>
  void choice(const char* name, const Enum& value, const core::Choices<Enum, N>& choices,
              const core::Origin& origin = {}) {
    add_other(name, choice_name(value, choices), choice_names(choices), origin);
  }

  template <class Config>
  void section(const char* name, Config& config) {
    ParameterTable inner(at(name));
    config.visit(inner);
    parameters_.insert(parameters_.end(), inner.parameters_.begin(), inner.parameters_.end());
  }

  /// A list shows its length and, once, the members of an element.
  template <class Config>
  void list(const char* name, std::vector<Config>& configs, std::size_t least,
            std::size_t greatest) {
    add_list(name, configs.size(), least, greatest);
    Config element;
    section((std::string(name) + "[]").c_str(), element);
  }

  const std::vector<Parameter>& parameters() const { return parameters_; }

 private:
  std::string at(const std::string& name) const {
    return path_.empty() ? name : path_ + '.' + name;
  }
  void add_number(const char* name, std::string value, std::string allowed,
                  const core::Origin& origin);
  void add_numbers(const char* name, const std::vector<double>& values, double least,
                   double greatest, const core::Origin& origin);
  void add_other(const char* name, std::string value, std::string allowed,
                 const core::Origin& origin);
  void add_list(const char* name, std::size_t size, std::size_t least, std::size_t greatest);

  std::string path_;
  std::vector<Parameter> parameters_;
};

/// One aligned line a parameter, under a line of headings.
std::string to_text(const std::vector<Parameter>& parameters);

}  // namespace nightjar::scenarios
