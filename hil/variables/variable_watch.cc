#include "hil/variables/variable_watch.h"

#include <fmt/format.h>

#include <limits>
#include <stdexcept>

#include "firmware_iface/firmware_memory.h"
#include "hil/loop/session_checks.h"
#include "hil/text/text_file.h"
#include "hil/variables/variable_value.h"

namespace omnihil {
namespace {

constexpr std::size_t kMostValues = 256;  // of all names of a watch: what a line of a recording is worth

// "NAME=VALUE"; names have no '=', templates' arguments aside.
std::pair<std::string, std::string> parted(const std::string& setting) {
  const std::size_t equals = setting.rfind('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == setting.size()) return {};
  return {setting.substr(0, equals), setting.substr(equals + 1)};
}

}  // namespace

std::shared_ptr<const DebugInfo> debug_info_of(const std::string& file) {
  std::string error;
  const std::string text = read_text_file(file, error);
  std::shared_ptr<const DebugInfo> info;
  if (error.empty()) info = DebugInfo::read({text.begin(), text.end()}, error);
  if (!error.empty()) throw_problems({fmt::format("variables of {}: {}", file, error)});
  return info;
}

VariableWatch::VariableWatch(const std::string& firmware_file, const std::vector<std::string>& names,
                             const std::vector<std::string>& settings, Session& session)
    : session_(session), values_(static_cast<std::size_t>(session.robot_count())) {
  FirmwareMemory* const first = session.firmware_memory(0);
  if (first == nullptr) {
    throw_problems({fmt::format("variables of {}: needed: an image on an emulated board, or a shared object",
                                firmware_file.empty() ? "the reference firmware" : firmware_file)});
  }
  variables_ = std::make_shared<VariableNames>(debug_info_of(firmware_file),
                                               VariableSpace{first->boards(), first->state_bytes()});
  std::vector<std::string> problems;
  for (const std::string& name : names) {
    std::string problem;
    const auto place = variables_->find(name, problem);
    const std::vector<VariablePlace> values =
        place ? variables_->values_of(*place, kMostValues + 1 - places_.size())
              : std::vector<VariablePlace>{};
    if (place && values.empty()) problem = "has no values";
    if (places_.size() + values.size() > kMostValues)
      problem = fmt::format("more than {} values", kMostValues);
    if (!problem.empty()) problems.push_back(fmt::format("variable {}: {}", name, problem));
    if (problem.empty()) places_.insert(places_.end(), values.begin(), values.end());
  }
  std::vector<std::pair<std::string, std::string>> wanted;
  for (const std::string& setting : settings) {
    wanted.push_back(parted(setting));
    const auto& [name, value] = wanted.back();
    if (name.empty()) {
      problems.push_back(fmt::format("--set {}: allowed: NAME=VALUE", setting));
    } else if (const std::string problem = set_problem(name, value); !problem.empty()) {
      problems.push_back(problem);
    }
  }
  throw_problems(problems);
  std::size_t bytes = 0;
  for (const VariablePlace& place : places_) {
    names_.push_back(place.name);
    if (place.constant.empty()) pieces_.push_back(place.piece);
    if (place.constant.empty()) bytes += place.piece.bytes;
  }
  for (Values& values : values_) {
    values.raw.resize(bytes);
    values.numbers.resize(places_.size());
  }
  for (int robot = 0; !wanted.empty() && robot < session.robot_count(); ++robot) {
    FirmwareMemory* const memory = session.firmware_memory(robot);
    if (memory == nullptr) continue;
    memory->when_started([variables = variables_, wanted, memory] {
      for (const auto& [name, value] : wanted) {
        std::string problem;
        if (const auto place = variables->find_value(name, problem))
          write(*variables, *memory, *place, value);
      }
    });
  }
}

std::string VariableWatch::set_problem(const std::string& name, const std::string& value) const {
  std::string problem;
  const auto place = variables_->find_value(name, problem);
  if (place) {
    std::vector<std::uint8_t> raw(place->piece.bytes);
    problem = value_bytes(value, variables_->info().type(place->type), *place, raw);
  }
  return problem.empty() ? problem : fmt::format("variable {}: {}", name, problem);
}

void VariableWatch::write(const VariableNames& names, FirmwareMemory& memory, const VariablePlace& place,
                          const std::string& value) {
  std::vector<std::uint8_t> raw(place.piece.bytes);
  if (!memory.read({&place.piece, 1}, raw)) return;
  if (value_bytes(value, names.info().type(place.type), place, raw).empty()) memory.write(place.piece, raw);
}

void VariableWatch::set(int robot_index, const std::string& name, const std::string& value) {
  const std::string problem = set_problem(name, value);
  if (!problem.empty()) throw_problems({problem});
  std::string none;
  FirmwareMemory* const memory = session_.firmware_memory(robot_index);
  if (memory != nullptr) write(*variables_, *memory, *variables_->find_value(name, none), value);
}

std::span<const double> VariableWatch::read(int robot_index, Firmware& firmware) {
  Values& values = values_[static_cast<std::size_t>(robot_index)];
  FirmwareMemory* const memory = firmware.memory();
  const bool there = pieces_.empty() || (memory != nullptr && memory->read(pieces_, values.raw));
  std::size_t at = 0;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const VariablePlace& place = places_[i];
    std::span<const std::uint8_t> raw = place.constant;
    if (raw.empty()) {
      raw = std::span(values.raw).subspan(at, place.piece.bytes);
      at += place.piece.bytes;
    }
    values.numbers[i] = there || !place.constant.empty()
                            ? number_of_value(variables_->info().type(place.type), place, raw)
                            : std::numeric_limits<double>::quiet_NaN();
  }
  return values.numbers;
}

std::string VariableWatch::text(int robot_index) const {
  const Values& values = values_[static_cast<std::size_t>(robot_index)];
  std::string text;
  std::size_t at = 0;
  for (const VariablePlace& place : places_) {
    std::span<const std::uint8_t> raw = place.constant;
    if (raw.empty()) {
      raw = std::span(values.raw).subspan(at, place.piece.bytes);
      at += place.piece.bytes;
    }
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", place.name,
                        text_of_value(variables_->info().type(place.type), place, raw));
  }
  return text;
}

}  // namespace omnihil
