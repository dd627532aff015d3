// The firmware that a user names, as a session takes it. Used by every verb that runs one.
//
//   FirmwareChoice choice{.file = "./libmyteam.so"};
//   Session session(config, open_firmware(choice, config));
//
//   (empty), reference the reference firmware that the robot's model asks for, in this process
//   a shared object    of this computer: by the C ABI (omnihil_firmware.h), each robot in a process of its own
//   a wire's URL       serial:/dev/ttyACM0, can:can0, …: a board on the desk (hil/firmware/remote_firmware.h)
//   a microcontroller image (32-bit ARM executable) with its board file: emulated, one board per robot
//   an AVR image (ELF or Intel HEX) with its board file: emulated by omnihil-avr, one board per wheel
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "hil/firmware/image_firmware.h"
#include "hil/loop/session.h"
#include "hil/text/hashed_file.h"

namespace omnihil {

class ImageObserver;

struct FirmwareChoice {
  std::string file{};                         // empty, "reference": the reference firmware
  std::string board{};                        // board file of a microcontroller image
  double deadline_s = 10.0;                   // of wall time: a call that takes longer hangs
  ImageListeners listeners{};                 // of emulated boards
  std::shared_ptr<ImageObserver> observer{};  // of what an image does (image_observer.h); null: nobody
  bool virtual_time = true;  // false: the run is paced by wall time, so a board on the desk is not waited for
};

// Throws std::invalid_argument, all problems in one text; the maker does, too, when a robot is refused.
Session::FirmwareMaker open_firmware(const FirmwareChoice& choice, const SessionConfig& session);

// A microcontroller image, which needs a board file. False too where the file cannot be read.
bool is_image(const std::string& file);

// What stands in for it where a bench is measured before it runs: an ARM image as it is, its ports closed and nobody
// listening; the reference firmware for all else, whose work is another process's or computer's.
Session::FirmwareMaker open_firmware_for_load(FirmwareChoice choice, const SessionConfig& session);

// The files it comes from; none of the reference firmware; a board on the desk has its wire's name and no hash.
// Throws std::system_error when one cannot be read.
std::vector<HashedFile> firmware_files(const FirmwareChoice& choice);

}  // namespace omnihil
