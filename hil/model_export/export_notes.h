// What an export leaves out: every number that a file gives and a format has no place for, and the laws behind them.
//
//   const std::vector<std::string> lost = numbers_lost(model, kSurvive);      // "encoder.counts_per_turn = 4096"
//   const std::string head = xml_comment(title, made);
#pragma once
#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hil/model_export/model_export.h"

namespace omnihil {

// "data sheet p. 7, +-10 %"; "": nothing is said of it
std::string origin_words(const Parameter& p);
// "2.632", "300, 60, 135, 225", a word
std::string value_words(const Parameter& p);

// Numbers and words that the file gives (defaults are none of its own), but for those at the paths in `survive`.
std::vector<std::string> numbers_lost(const ModelFile& model, std::span<const std::string_view> survive);
// Effects by name: Coulomb friction, which joints have, is none of them.
std::vector<std::string> effects_lost(const ModelFile& model);

// Title, what is lost, what is assumed, as one comment. "--", which XML forbids there, becomes "- -".
std::string xml_comment(const std::string& title, const ModelExport& made);
// The origin of some numbers, a line each, as one comment.
std::string origins_comment(const ModelFile& model, std::span<const std::string_view> paths);

// Shortest text that reads back as the same double.
std::string exact(double value);
std::string vec(const Eigen::Vector3d& v);  // "x y z", each as above

// The formats (export_robot() calls them).
ModelExport robot_mjcf(const ModelFile& model, const std::string& name);
ModelExport robot_urdf(const ModelFile& model, const std::string& name);
ModelExport robot_c_header(const ModelFile& model, const std::string& name);

}  // namespace omnihil
