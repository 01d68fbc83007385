#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scenarios/choice_text.h"

namespace YAML {
class Emitter;
}

namespace nightjar::scenarios {

/// A visitor (core/config_check.h) that writes every member of a config struct
/// as YAML, with its allowed range as a comment. Numbers are written shortest
/// and read back to the same bits.
class YamlWriter {
 public:
  YamlWriter();
  ~YamlWriter();

  void field(const char* name, const double& value, double least, double greatest,
             const core::Origin& = {});
  void field(const char* name, const int& value, int least, int greatest, const core::Origin& = {});
  void field(const char* name, const bool& value, const core::Origin& = {});
  void field(const char* name, const std::string& value, const core::Origin& = {});
  template <std::size_t N>
  void field(const char* name, const std::array<double, N>& value, double least, double greatest,
             const core::Origin& = {}) {
    write_numbers(name, value, least, greatest);
  }

  template <class Enum, std::size_t N>
  void choice(const char* name, const Enum& value, const core::Choices<Enum, N>& choices,
              const core::Origin& = {}) {
    write_choice(name, choice_name(value, choices), choice_names(choices));
  }

  template <class Config>
  void section(const char* name, Config& config) {
    key(name);
    write(config);
  }

  template <class Config>
  void list(const char* name, std::vector<Config>& configs, std::size_t, std::size_t) {
    key(name);
    begin_list();
    for (Config& config : configs) write(config);
    end_list();
  }

  /// Everything between the braces of one struct.
  template <class Config>
  void write(Config& config) {
    begin_map();
    config.visit(*this);
    end_map();
  }

  /// The document so far.
  std::string text() const;

 private:
  void key(const char* name);
  void begin_map();
  void end_map();
  void begin_list();
  void end_list();
  void write_numbers(const char* name, std::span<const double> values, double least,
                     double greatest);
  void write_choice(const char* name, const std::string& value, const std::string& allowed);

  std::unique_ptr<YAML::Emitter> emitter_;
};

/// `config` as a YAML document that read_yaml() turns back into the same struct.
template <class Config>
std::string to_yaml(Config config) {
  YamlWriter writer;
  writer.write(config);
  return writer.text();
}

}  // namespace nightjar::scenarios
