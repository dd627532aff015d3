// The model of an axis as a file gives it: base parameters, effects, encoder.
//
//   AxisReading r = read_axis_model(text, "bench.toml", load_motor);
//   if (r.model) run_axis(r.model->drive, EffectSet<double>(r.model->effects), input);
//
// A robot's file is taken as one of its wheel drives with the wheel as its load, lifted; a motor's file as
// the bare motor. Problems of base parameters and of effects come together.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/law/drive_params.h"
#include "sim/law/effect_set.h"
#include "sim/model/model_file.h"

namespace omnihil {

struct AxisModel {
  ModelFile file;  // name, rig, table of base parameters with tolerances and sources
  DriveParams<double> drive;
  std::vector<EffectUse> effects;
  bool has_servo = false;
  bool has_electrics = false;  // resistance and torque constant are there
  double encoder_counts_per_turn = 0.0;
};

struct AxisReading {
  std::optional<AxisModel> model;  // only without problems
  std::vector<ModelProblem> problems;
};

AxisReading read_axis_model(std::string_view text, const std::string& shown_name,
                            const MotorFileLoader& load_motor);

// The numbers of the table in their places; what the table lacks stays at the struct's defaults.
DriveParams<double> drive_params_of(const ParameterTable& table);

}  // namespace omnihil
