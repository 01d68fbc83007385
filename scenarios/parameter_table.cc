#include "scenarios/parameter_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenarios/parameter_unit.h"
#include "scenarios/text_table.h"

namespace nightjar::scenarios {
namespace {

std::string range(double least, double greatest) {
  return core::number_text(least) + " to " + core::number_text(greatest);
}

}  // namespace

void ParameterTable::field(const char* name, const double& value, double least, double greatest,
                           const core::Origin& origin) {
  add_number(name, core::number_text(value), range(least, greatest), origin);
}

void ParameterTable::field(const char* name, const int& value, int least, int greatest,
                           const core::Origin& origin) {
  add_number(name, std::to_string(value), range(least, greatest), origin);
}

void ParameterTable::field(const char* name, const bool& value, const core::Origin& origin) {
  add_other(name, value ? "true" : "false", "true, false", origin);
}

void ParameterTable::field(const char* name, const std::string& value, const core::Origin& origin) {
  add_other(name, '"' + value + '"', "text", origin);
}

void ParameterTable::add_number(const char* name, std::string value, std::string allowed,
                                const core::Origin& origin) {
  const std::string declared = origin.unit;
  parameters_.push_back({at(name), std::move(value), std::move(allowed),
                         declared.empty() ? unit_of(name) : declared, origin.source});
}

void ParameterTable::add_numbers(const char* name, const std::vector<double>& values, double least,
                                 double greatest, const core::Origin& origin) {
  std::vector<std::string> texts;
  for (const double value : values) texts.push_back(core::number_text(value));
  add_number(name, fmt::format("[{}]", fmt::join(texts, ", ")), range(least, greatest), origin);
}

void ParameterTable::add_other(const char* name, std::string value, std::string allowed,
                               const core::Origin& origin) {
  parameters_.push_back({at(name), std::move(value), std::move(allowed), "-", origin.source});
}

void ParameterTable::add_list(const char* name, std::size_t size, std::size_t least,
                              std::size_t greatest) {
  add_other(name, fmt::format("list of {}", size),
            fmt::format("{} to {} elements", least, greatest), {});
}

std::string to_text(const std::vector<Parameter>& parameters) {
  std::vector<std::vector<std::string>> rows = {
      {"parameter", "default", "allowed", "unit", "source"}};
  for (const Parameter& p : parameters)
    rows.push_back({p.path, p.default_value, p.allowed, p.unit, p.source});
  return text_table(rows);
}

}  // namespace nightjar::scenarios
