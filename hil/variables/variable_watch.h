// Variables of the robots' firmware, by name, in a session: read after each control tick, set at the start and on the
// way.
//
//   VariableWatch watch("wheels.elf", {"wheel[2].integral"}, {"gain=0.5"}, session);   // std::invalid_argument: all problems
//   session.set_watch(&watch);          // RobotSample::watched, in the order of watch.names()
//   watch.set(0, "gain", "0.7");        // now; likewise
//
// All robots of the session run that one firmware. A struct or an array stands for all of its values.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hil/loop/session.h"
#include "hil/variables/variable_place.h"

namespace omnihil {

class VariableWatch final : public FirmwareWatch {
 public:
  // `settings`: "NAME=VALUE", for every robot, as soon as start-up code is through.
  VariableWatch(const std::string& firmware_file, const std::vector<std::string>& names,
                const std::vector<std::string>& settings, Session& session);

  const std::vector<std::string>& names() const { return names_; }
  std::span<const double> read(int robot_index, Firmware& firmware) override;
  void set(int robot_index, const std::string& name, const std::string& value);
  // Why it cannot be set so; empty: it can.
  std::string set_problem(const std::string& name, const std::string& value) const;
  // "wheel[2].integral 0.25, mode kDriving" of what was read last.
  std::string text(int robot_index) const;

 private:
  struct Values {
    std::vector<std::uint8_t> raw;
    std::vector<double> numbers;
  };
  static void write(const VariableNames& names, FirmwareMemory& memory, const VariablePlace& place,
                    const std::string& value);

  Session& session_;
  std::shared_ptr<const VariableNames> variables_;
  std::vector<VariablePlace> places_;
  std::vector<MemoryPiece> pieces_;  // of those that are no constants
  std::vector<std::string> names_;
  std::vector<Values> values_;  // by robot
};

// Of the file that a firmware comes from. Throws std::invalid_argument: it cannot be read, or has no debug information.
std::shared_ptr<const DebugInfo> debug_info_of(const std::string& file);

}  // namespace omnihil
