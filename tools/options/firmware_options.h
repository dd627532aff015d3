// The options with which a verb lets its user name firmware: the same words for all of them.
//
//   add_firmware_options(verb, choice);               // --firmware, --board, --firmware-deadline
//   add_team_firmware_options(verb, words);           // these, and of single robots and of the other team
//   TeamFirmware makers = open_team_firmware(words, config);
#pragma once
#include <string>
#include <vector>

#include "hil/firmware/open_firmware.h"
#include "tools/command_line.h"

namespace omnihil {

struct TeamFirmwareWords {
  FirmwareChoice all;
  std::vector<std::string> of;  // "3,4=libother.so", "5=image.elf+board.toml"
  std::string opponents, opponents_board;
  bool names_any() const { return !all.file.empty() || !of.empty() || !opponents.empty(); }
};

struct TeamFirmware {
  Session::FirmwareMaker first, opponents;  // opponents: empty where there are none
};

void add_firmware_options(Verb& verb, FirmwareChoice& choice);
void add_team_firmware_options(Verb& verb, TeamFirmwareWords& words);

// Throws std::invalid_argument with every problem, a line each. `config` may be of one team alone.
Session::FirmwareMaker open_first_firmware(const TeamFirmwareWords& words, const SessionConfig& config);
Session::FirmwareMaker open_opponents_firmware(const TeamFirmwareWords& words, const SessionConfig& alone);
TeamFirmware open_team_firmware(const TeamFirmwareWords& words, const SessionConfig& config);
// Of the same words, to measure a bench by (open_firmware_for_load()).
TeamFirmware open_team_firmware_for_load(const TeamFirmwareWords& words, const SessionConfig& config);

// Of all of them, each once.
std::vector<HashedFile> team_firmware_files(const TeamFirmwareWords& words);

}  // namespace omnihil
