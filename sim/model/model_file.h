// Reads a model (format omnihil-model/1): a robot, an axis or a motor, from TOML text. No file is opened
// here; the text of a referenced motor file comes from the caller.
//
//   ModelReading r = read_model(text, "robots/my_robot.toml", load_motor);    // load_motor: a file's name to its text
//   for (const ModelProblem& p : r.problems) std::cerr << p.text() << "\n";   // all of them, not the first
//   if (r.model) robots.push_back(*r.model->robot);
//
// A number is bare (known exactly) or { value = 1.2, tolerance = 0.1, source = "data sheet" }; tolerance is
// the relative 1-sigma. Keys, units and bounds: model_rows.h. Keys of the robot's file override the motor
// file's. [effects.NAME] tables become the robot's effects; coulomb_friction is a number of its base model.
// An axis reads its effects itself (sim/model/axis_model.h).
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/model/params.h"
#include "sim/robot/robot_model.h"

namespace omnihil {

// One thing wrong with a model, and how to mend it.
struct ModelProblem {
  std::string file;
  int line = 0;  // 0: the file as a whole
  int column = 0;
  std::string key;      // "motor.resistance_ohm"; empty: the file as a whole
  std::string value;    // as it stands in the file; empty: none
  std::string what;     // what is wrong
  std::string allowed;  // what is allowed, or the nearest spelling

  std::string text()
      const;  // "robot.toml:12:1: motor.resistance_ohm = -1: out of range; allowed: more than 0 …"
};

std::string lines_of(const std::vector<ModelProblem>& problems);

struct ModelEffect {
  std::string id;
  bool simulated = false;  // false: kept in the file, without influence on the simulation
};

// Copied and destroyed in model_file.cc, once, instead of in every file that holds one: 10 kB of code each.
struct ModelFile {
  ModelFile();
  ModelFile(const ModelFile&);
  ModelFile(ModelFile&&) noexcept;
  ModelFile& operator=(const ModelFile&);
  ModelFile& operator=(ModelFile&&) noexcept;
  ~ModelFile();

  std::string name;
  std::string source;
  std::string rig;  // "robot", "axis", "motor"
  bool linear = false;
  std::string radio;       // radio format hint, may be empty
  std::string motor_file;  // as the file names it; empty: the motor is in the robot's own file
  std::string motor_name;
  std::string motor_source;
  ParameterTable parameters;  // every row of this rig: given or default
  std::vector<ModelEffect> effects;
  std::optional<RobotModel> robot;  // rig "robot"
  MotorParams motor;                // every rig but a linear axis
};

struct MotorFileText {
  std::string shown_name;  // for messages
  std::string text;
  std::string error;  // not empty: why it could not be had
};
using MotorFileLoader = std::function<MotorFileText(const std::string& file)>;

struct ModelReading {
  std::optional<ModelFile> model;  // only without problems
  std::vector<ModelProblem> problems;
  std::vector<std::string> notes;  // true but not wrong: effects kept but not simulated
};

ModelReading read_model(std::string_view text, const std::string& shown_name,
                        const MotorFileLoader& load_motor);

}  // namespace omnihil
