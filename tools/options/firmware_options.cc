#include "tools/options/firmware_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "hil/loop/session_checks.h"
#include "hil/recording/session_setup.h"

namespace omnihil {
namespace {

struct OfRobots {
  std::vector<int> ids;
  FirmwareChoice choice;
};

constexpr std::string_view kOther = "opponents:";

// "3,4=FILE" or "3,4=FILE+BOARD", with opponents: before it of the other team.
std::vector<OfRobots> read_of(const TeamFirmwareWords& words, bool opponents,
                              std::vector<std::string>& problems) {
  std::vector<OfRobots> all;
  for (const std::string& text : words.of) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
      problems.push_back(
          fmt::format("--firmware-of: found \"{}\", allowed: IDS=FILE or IDS=IMAGE+BOARD such as "
                      "3,4=libother.so",
                      text));
      continue;
    }
    if (text.starts_with(kOther) != opponents) continue;
    OfRobots& robots = all.emplace_back();
    const std::size_t first = opponents ? kOther.size() : 0;
    robots.ids = parse_robot_list(std::string_view(text).substr(first, equals - first), problems);
    const std::string file = text.substr(equals + 1);
    const std::size_t plus = file.rfind('+');
    robots.choice = words.all;
    robots.choice.file = file.substr(0, plus);
    robots.choice.board = plus == std::string::npos ? "" : file.substr(plus + 1);
  }
  return all;
}

FirmwareChoice opponents_choice(const TeamFirmwareWords& words) {
  FirmwareChoice choice = words.all;
  choice.listeners = {};  // who listens knows robots of the first team
  choice.observer = nullptr;
  if (words.opponents.empty()) return choice;
  choice.file = words.opponents;
  choice.board = words.opponents_board;
  return choice;
}

}  // namespace

void add_firmware_options(Verb& verb, FirmwareChoice& choice) {
  verb.add_option(
      "--firmware", choice.file,
      "a shared object of this computer (docs/firmware.md), a microcontroller image "
      "(docs/mcu-boards.md) or a board on the desk by its wire, such as serial:/dev/ttyACM0 "
      "(docs/remote-mcu.md, omnihil wires); without it, or with reference: the reference firmware");
  verb.add_option("--board", choice.board, "board file of a microcontroller image");
  verb.add_option("--firmware-deadline", choice.deadline_s,
                  "a call of the firmware that takes longer (s of wall time) is a hang")
      .capture_default_str();
}

void add_team_firmware_options(Verb& verb, TeamFirmwareWords& words) {
  add_firmware_options(verb, words.all);
  verb.add_option("--firmware-of", words.of,
                  "IDS=FILE or IDS=IMAGE+BOARD: robots that run another firmware, such as 3,4=libother.so or "
                  "opponents:0=libtheirs.so; several allowed");
  verb.add_option("--opponents-firmware", words.opponents,
                  "what the other team runs (default: as --firmware)");
  verb.add_option("--opponents-board", words.opponents_board, "board file of the other team's image");
}

namespace {

// `config` of one team, `choice` what its robots run that are not named.
using Opener = Session::FirmwareMaker(const FirmwareChoice& choice, const SessionConfig& session);

Session::FirmwareMaker for_load(const FirmwareChoice& choice, const SessionConfig& session) {
  return open_firmware_for_load(choice, session);
}

Session::FirmwareMaker open_of(const TeamFirmwareWords& words, bool opponents, const FirmwareChoice& choice,
                               const SessionConfig& config, Opener* open = open_firmware) {
  std::vector<std::string> problems;
  const std::vector<OfRobots> others = read_of(words, opponents, problems);
  std::map<std::uint32_t, std::size_t> other_of;  // by id, place in others
  for (std::size_t i = 0; i < others.size(); ++i) {
    for (const int id : others[i].ids) {
      if (!std::ranges::binary_search(config.robot_ids, id))
        problems.push_back(fmt::format("--firmware-of: robot {} is not on the floor", id));
      if (!other_of.emplace(static_cast<std::uint32_t>(id), i).second)
        problems.push_back(fmt::format("--firmware-of: robot {} has two", id));
    }
  }
  throw_problems(problems);
  const Session::FirmwareMaker usual = open(choice, config);
  std::vector<Session::FirmwareMaker> makers;
  for (const OfRobots& robots : others) makers.push_back(open(robots.choice, config));
  if (makers.empty()) return usual;
  return [usual, makers, other_of](const RobotConfig& robot) {
    const auto found = other_of.find(robot.robot_id);
    return found == other_of.end() ? usual(robot) : makers[found->second](robot);
  };
}

}  // namespace

Session::FirmwareMaker open_first_firmware(const TeamFirmwareWords& words, const SessionConfig& config) {
  return open_of(words, false, words.all, config);
}

Session::FirmwareMaker open_opponents_firmware(const TeamFirmwareWords& words, const SessionConfig& alone) {
  if (words.opponents.empty() && !words.opponents_board.empty())
    throw_problems({"--opponents-board: needs --opponents-firmware IMAGE beside it"});
  return open_of(words, true, opponents_choice(words), alone);
}

TeamFirmware open_team_firmware(const TeamFirmwareWords& words, const SessionConfig& config) {
  TeamFirmware makers;
  SessionConfig first = config;
  first.opponents = {};
  makers.first = open_first_firmware(words, first);
  if (!config.opponents.robots.empty())
    makers.opponents = open_opponents_firmware(words, opponents_alone(config));
  else if (!words.opponents.empty())
    throw_problems({"--opponents-firmware: needs --opponents"});
  return makers;
}

TeamFirmware open_team_firmware_for_load(const TeamFirmwareWords& words, const SessionConfig& config) {
  TeamFirmware makers;
  SessionConfig first = config;
  first.opponents = {};
  makers.first = open_of(words, false, words.all, first, for_load);
  if (config.opponents.robots.empty()) return makers;
  const SessionConfig alone = opponents_alone(config);
  makers.opponents = open_of(words, true, opponents_choice(words), alone, for_load);
  return makers;
}

std::vector<HashedFile> team_firmware_files(const TeamFirmwareWords& words) {
  std::vector<HashedFile> files = firmware_files(words.all);
  const auto add = [&files](const FirmwareChoice& choice) {
    for (HashedFile& file : firmware_files(choice))
      if (std::ranges::find(files, file) == files.end()) files.push_back(std::move(file));
  };
  std::vector<std::string> problems;  // named when it was opened
  for (const bool opponents : {false, true})
    for (const OfRobots& robots : read_of(words, opponents, problems)) add(robots.choice);
  if (!words.opponents.empty()) add(opponents_choice(words));
  return files;
}

}  // namespace omnihil
