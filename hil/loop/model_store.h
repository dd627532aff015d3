// Finds and reads model files: robots, motors and axes, by path or by name.
//
//   StoredModel m = load_model("roboteam_2024", {"/usr/share/omnihil/models"});
//   if (!m.model) for (const ModelProblem& p : m.problems) std::cerr << p.text() << "\n";
//   setup.model = m.bundle;                           // a recording carries the texts, not the paths
//   ModelReading again = read_bundle(m.bundle);       // later, anywhere, without any file
//
// A name without a slash and without ".toml" is looked for as robots/NAME.toml, motors/NAME.toml and
// NAME.toml in every folder of $OMNIHIL_MODELS (separated by ':'), then in the folders given.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "sim/model/axis_model.h"
#include "sim/model/model_file.h"

namespace omnihil {

// Everything a model was read from.
struct ModelBundle {
  std::string name;        // the model's id: its file name without .toml
  std::string robot_file;  // for messages
  std::string robot_text;
  std::string motor_file;  // as the robot's file names it; empty: none
  std::string motor_text;

  bool operator==(const ModelBundle&) const = default;
};

struct StoredModel {
  ModelBundle bundle;
  std::optional<ModelFile> model;  // only without problems
  std::vector<ModelProblem> problems;
  std::vector<std::string> notes;
};

// $OMNIHIL_MODELS before `folders`.
std::vector<std::string> model_folders(const std::vector<std::string>& folders);

// Any rig.
StoredModel load_model(const std::string& path_or_name, const std::vector<std::string>& folders);

// The same, and a problem when it is not a robot: on success model->robot has a value.
StoredModel load_robot_model(const std::string& path_or_name, const std::vector<std::string>& folders);

ModelReading read_bundle(const ModelBundle& bundle);
AxisReading read_axis_bundle(const ModelBundle& bundle);  // a robot's, a motor's too (axis_model.h)

struct ModelListing {
  std::string name;
  std::string path;
};
// Every .toml under robots/ and motors/ of the folders, robots first, by name; a name found twice is listed
// once.
std::vector<ModelListing> list_models(const std::vector<std::string>& folders);

}  // namespace omnihil
