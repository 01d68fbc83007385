#include "scenarios/yaml_writer.h"

#include <fmt/format.h>
#include <yaml-cpp/emitter.h>

namespace nightjar::scenarios {
namespace {

YAML::_Comment range(double least, double greatest) {
  return YAML::Comment(core::number_text(least) + " to " + core::number_text(greatest));
}

}  // namespace

YamlWriter::YamlWriter() : emitter_(std::make_unique<YAML::Emitter>()) {}
YamlWriter::~YamlWriter() = default;

void YamlWriter::field(const char* name, const double& value, double least, double greatest,
                       const core::Origin&) {
  key(name);
  *emitter_ << fmt::format("{}", value) << range(least, greatest);
}

void YamlWriter::field(const char* name, const int& value, int least, int greatest,
                       const core::Origin&) {
  key(name);
  *emitter_ << value << range(least, greatest);
}

void YamlWriter::field(const char* name, const bool& value, const core::Origin&) {
  key(name);
  *emitter_ << value << YAML::Comment("true, false");
}

void YamlWriter::field(const char* name, const std::string& value, const core::Origin&) {
  key(name);
  *emitter_ << YAML::DoubleQuoted << value;
}

std::string YamlWriter::text() const { return std::string(emitter_->c_str()) + '\n'; }

void YamlWriter::key(const char* name) { *emitter_ << YAML::Key << name << YAML::Value; }
void YamlWriter::begin_map() { *emitter_ << YAML::BeginMap; }
void YamlWriter::end_map() { *emitter_ << YAML::EndMap; }
void YamlWriter::begin_list() { *emitter_ << YAML::BeginSeq; }
void YamlWriter::end_list() { *emitter_ << YAML::EndSeq; }

void YamlWriter::write_numbers(const char* name, std::span<const double> values, double least,
                               double greatest) {
  key(name);
  *emitter_ << YAML::Flow << YAML::BeginSeq;
  for (const double value : values) *emitter_ << fmt::format("{}", value);
  *emitter_ << YAML::EndSeq << range(least, greatest);
}

void YamlWriter::write_choice(const char* name, const std::string& value,
                              const std::string& allowed) {
  key(name);
  *emitter_ << value << YAML::Comment(allowed);
}

}  // namespace nightjar::scenarios
