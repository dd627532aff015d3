#include "hil/firmware/open_firmware.h"

#include <elf.h>
#include <fmt/format.h>

#include <cstring>
#include <fstream>
#include <map>

#include "firmware_iface/mcu/avr/avr_image.h"
#include "hil/firmware/avr_firmware.h"
#include "hil/firmware/guarded_firmware.h"
#include "hil/firmware/image_firmware.h"
#include "hil/firmware/remote_firmware.h"
#include "hil/loop/reference_firmware.h"
#include "hil/loop/session_checks.h"
#include "hil/text/text_file.h"
#include "hil/wire/wire_url.h"
#include "sim/robot/electric_model.h"

namespace omnihil {
namespace {

// Of the ELF header's e_machine (elf.h): those that a firmware file by mistake is for.
std::string machine_text(unsigned machine) {
  struct Row {
    unsigned number;
    const char* name;
  };
  constexpr Row kRows[] = {{EM_386, "x86"},       {EM_MIPS, "MIPS"},       {EM_PPC, "PowerPC"},
                           {EM_ARM, "ARM"},       {EM_X86_64, "x86-64"},   {EM_AVR, "AVR"},
                           {EM_XTENSA, "Xtensa"}, {EM_AARCH64, "AArch64"}, {EM_RISCV, "RISC-V"}};
  for (const Row& row : kRows) {
    if (row.number == machine) return fmt::format("{} (machine {})", row.name, machine);
  }
  return fmt::format("machine {}", machine);
}

std::string type_text(unsigned type) {
  constexpr const char* kNames[] = {"no type", "an object file that is not linked", "an executable",
                                    "a shared object", "a core dump"};
  return type < std::size(kNames) ? kNames[type] : fmt::format("type {}", type);
}

// What kind of file it is by its first bytes (System V ABI, ELF header); empty: a shared object.
std::string why_no_library(const std::string& text) {
  Elf32_Ehdr head{};  // type and machine are at the same place in both classes
  if (text.size() < sizeof head || std::memcmp(text.data(), ELFMAG, SELFMAG) != 0) {
    return "is no shared object (no ELF file)";
  }
  std::memcpy(&head, text.data(), sizeof head);
  if (head.e_type == ET_DYN) return {};
  return fmt::format("is an ELF file for {}, {}; needed: a shared object of this computer",
                     machine_text(head.e_machine), type_text(head.e_type));
}

// Beside a board file it has to be an image.
std::string why_no_image(const std::string& text) {
  Elf32_Ehdr head{};
  std::string what = "is neither an ELF file nor Intel HEX";
  if (text.size() >= sizeof head && std::memcmp(text.data(), ELFMAG, SELFMAG) == 0) {
    std::memcpy(&head, text.data(), sizeof head);
    what = fmt::format("is an ELF file for {}, {}", machine_text(head.e_machine), type_text(head.e_type));
  }
  return what +
         "; needed with --board: a 32-bit ARM executable (machine 40), an AVR executable (machine 83) or "
         "Intel HEX for an AVR";
}

// An image for a microcontroller: a 32-bit ARM executable, an AVR one, or Intel HEX.
enum class ImageKind { kNone, kArm, kAvr };
ImageKind image_kind(const std::string& file) {
  std::string error;
  const std::string text = read_text_file(file, error);
  if (!error.empty()) return ImageKind::kNone;
  if (mcu::is_avr_image({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}))
    return ImageKind::kAvr;
  Elf32_Ehdr head{};
  if (text.size() < sizeof head) return ImageKind::kNone;
  std::memcpy(&head, text.data(), sizeof head);
  const bool arm =
      std::memcmp(head.e_ident, ELFMAG, SELFMAG) == 0 && head.e_type == ET_EXEC && head.e_machine == EM_ARM;
  return arm ? ImageKind::kArm : ImageKind::kNone;
}

bool is_reference(const FirmwareChoice& choice) { return choice.file.empty() || choice.file == "reference"; }

std::vector<std::string> problems_of(const FirmwareChoice& choice) {
  std::vector<std::string> problems;
  std::string error;
  const std::string text = read_text_file(choice.file, error);
  if (error.empty()) error = choice.board.empty() ? why_no_library(text) : why_no_image(text);
  if (!error.empty()) problems.push_back(fmt::format("firmware {}: {}", choice.file, error));
  if (!(choice.deadline_s > 0.0 && choice.deadline_s <= 3600.0)) {
    problems.push_back(
        fmt::format("firmware deadline: {} s; allowed: above 0, up to 3600 s", choice.deadline_s));
  }
  return problems;
}

Session::FirmwareMaker library_maker(const FirmwareChoice& choice, const SessionConfig& session) {
  std::map<std::uint32_t, std::optional<MotorConfig>> motors;
  // Opponents with an id of ours: as that robot. Where they differ: opponents_alone().
  const auto note = [&motors](const std::vector<RobotModel>& models, const std::vector<int>& ids) {
    for (std::size_t i = 0; i < std::min(models.size(), ids.size()); ++i) {
      const auto [of_robot, is_new] = motors.try_emplace(static_cast<std::uint32_t>(ids[i]));
      if (is_new && electrics_of(models[i]).three_phase()) of_robot->second = motor_config(models[i]);
    }
  };
  note(session.robots, session.robot_ids);
  note(session.opponents.robots, session.opponents.robot_ids);
  const GuardedLibrary library{choice.file, choice.deadline_s};
  return [library, motors = std::move(motors)](const RobotConfig& config) -> std::unique_ptr<Firmware> {
    return std::make_unique<GuardedFirmware>(library, config, motors.at(config.robot_id));
  };
}

}  // namespace

bool is_image(const std::string& file) { return image_kind(file) != ImageKind::kNone; }

std::vector<HashedFile> firmware_files(const FirmwareChoice& choice) {
  if (is_reference(choice)) return {};
  if (looks_like_wire(choice.file)) return {{choice.file, ""}};
  std::vector<HashedFile> files{hash_file(choice.file)};
  if (!choice.board.empty()) files.push_back(hash_file(choice.board));
  return files;
}

Session::FirmwareMaker open_firmware_for_load(FirmwareChoice choice, const SessionConfig& session) {
  const bool named = !is_reference(choice) && !looks_like_wire(choice.file);
  if (!named || image_kind(choice.file) != ImageKind::kArm) return reference_firmware_for(session);
  choice.listeners = {.ports = false};
  choice.observer = nullptr;
  return open_firmware(choice, session);
}

Session::FirmwareMaker open_firmware(const FirmwareChoice& choice, const SessionConfig& session) {
  if (is_reference(choice)) {
    if (!choice.board.empty()) {
      throw_problems({fmt::format("board {}: needs --firmware IMAGE beside it", choice.board)});
    }
    return reference_firmware_for(session);
  }
  if (looks_like_wire(choice.file)) {
    if (!choice.board.empty()) {
      throw_problems({fmt::format(
          "board {}: belongs to a microcontroller image; a board on the desk has none", choice.board)});
    }
    return remote_firmware({.url = choice.file, .lock_step = choice.virtual_time}, session);
  }
  if (const ImageKind kind = image_kind(choice.file); kind != ImageKind::kNone) {
    if (choice.board.empty()) {
      throw_problems(
          {fmt::format("firmware {}: a microcontroller image; needs --board FILE beside it", choice.file)});
    }
    return kind == ImageKind::kArm
               ? image_firmware(choice.file, choice.board, session.radio_format, choice.listeners,
                                choice.observer)
               : avr_firmware(choice.file, choice.board, choice.deadline_s, session.radio_format);
  }
  throw_problems(problems_of(choice));
  return library_maker(choice, session);
}

}  // namespace omnihil
