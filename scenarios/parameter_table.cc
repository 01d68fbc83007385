#include "scenarios/parameter_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace nightjar::scenarios {
namespace {

std::string range(double least, double greatest) {
  return core::number_text(least) + " to " + core::number_text(greatest);
}

}  // namespace

void ParameterTable::field(const char* name, const double& value, double least, double greatest) {
  add(name, core::number_text(value), range(least, greatest));
}

void ParameterTable::field(const char* name, const int& value, int least, int greatest) {
  add(name, std::to_string(value), range(least, greatest));
}

void ParameterTable::field(const char* name, const bool& value) {
  add(name, value ? "true" : "false", "true, false");
}

void ParameterTable::field(const char* name, const std::string& value) {
  add(name, '"' + value + '"', "text");
}

void ParameterTable::add(const char* name, std::string value, std::string allowed) {
  parameters_.push_back({at(name), std::move(value), std::move(allowed)});
}

void ParameterTable::add_numbers(const char* name, const std::vector<double>& values, double least,
                                 double greatest) {
  std::vector<std::string> texts;
  for (const double value : values) texts.push_back(core::number_text(value));
  add(name, fmt::format("[{}]", fmt::join(texts, ", ")), range(least, greatest));
}

void ParameterTable::add_list(const char* name, std::size_t size, std::size_t least,
                              std::size_t greatest) {
  add(name, fmt::format("list of {}", size), fmt::format("{} to {} elements", least, greatest));
}

std::string to_text(const std::vector<Parameter>& parameters) {
  std::vector<Parameter> rows = {{"parameter", "default", "allowed"}};
  rows.insert(rows.end(), parameters.begin(), parameters.end());
  std::size_t path_width = 0;
  std::size_t value_width = 0;
  for (const Parameter& row : rows) {
    path_width = std::max(path_width, row.path.size());
    value_width = std::max(value_width, row.default_value.size());
  }
  std::string text;
  for (const Parameter& row : rows)
    text += fmt::format("{:<{}}  {:<{}}  {}\n", row.path, path_width, row.default_value,
                        value_width, row.allowed);
  return text;
}

}  // namespace nightjar::scenarios
