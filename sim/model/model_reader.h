// Walks one document and collects its values and its problems; model_file.cc puts one or two such walks
// (robot and motor) together.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "sim/model/model_document.h"
#include "sim/model/model_rows.h"

namespace omnihil {

class ModelReader {
 public:
  ModelReader(const ModelDocument& document, std::vector<ModelProblem>& problems);

  // Bits of the rig this file declares; 0 and a problem when it does not say.
  std::uint32_t rig() const { return rig_; }
  void read(Origin origin);

  // What the file gives, by row. Rows it spoils are in spoilt(): their absence is not a second problem.
  const std::map<const ParameterRow*, Parameter>& values() const { return values_; }
  bool spoilt(const ParameterRow& row) const { return spoilt_.contains(&row); }
  const std::vector<ModelEffect>& effects() const { return effects_; }

  // Where to point for something that is missing from a section: its header, or the file's start.
  toml::source_region section_place(std::string_view section) const;

 private:
  void read_rig();
  void read_section(const std::string& section, const toml::table& table);
  void read_effects(const toml::table& table);
  void read_value(const ParameterRow& row, const toml::key& key, const toml::node& node);
  void read_annotated(const ParameterRow& row, const toml::table& table);
  void read_fit(const ParameterRow& row, const toml::table& table, Parameter& out);
  bool read_numbers(const ParameterRow& row, const toml::node& node, Parameter& out);
  bool read_number(const ParameterRow& row, const toml::node& node, double& out);
  bool read_text(const ParameterRow& row, const toml::node& node, Parameter& out);
  void read_tolerance(const ParameterRow& row, const toml::node& node, Parameter& out);
  void unknown_key(const std::string& section, const toml::key& key, const toml::node& node);
  void spoil(std::string_view path);
  void wrong(const toml::node& node, const std::string& key, std::string what, std::string allowed);

  const ModelDocument& document_;
  std::vector<ModelProblem>& problems_;
  std::uint32_t rig_ = 0;
  Origin origin_ = Origin::kRobotFile;
  std::map<const ParameterRow*, Parameter> values_;
  std::map<const ParameterRow*, bool> spoilt_;
  std::vector<ModelEffect> effects_;
};

}  // namespace omnihil
