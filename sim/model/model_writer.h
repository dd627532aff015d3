// Writes a model file (format "omnihil-model/1"): the numbers of a table, beliefs and fits kept (fitted_number.h),
// and the model's effects, in one text that the reader (model_file.h, axis_model.h) takes back with the same
// numbers.
//
//   std::string text = model_text(file, effects);
//
// A motor's own file is flattened into the text. What no file gave stays out: it is the format's default.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "sim/law/effect_set.h"
#include "sim/law/toml_text.h"
#include "sim/model/model_file.h"

namespace omnihil {

// RigBit of a model.
std::uint32_t rig_bit(const ModelFile& file);

// "resistance_ohm = { value = 0.46, tolerance = 0.1 }\n", with as many digits as give the same double back.
std::string parameter_line(std::string_view key, const Parameter& parameter);

std::string model_text(const ModelFile& file, std::span<const EffectUse> effects);

}  // namespace omnihil
