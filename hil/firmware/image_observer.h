// Somebody who looks at what images do while they run: traces, coverage, profiles.
//
//   FirmwareChoice choice{.file = "fw.elf", .board = "mine.toml", .observer = tracer};
//   Session session(config, open_firmware(choice, config));        // tracer->begins(…) for each robot
#pragma once
#include <cstdint>

#include "firmware_iface/mcu/board/mcu_firmware.h"

namespace omnihil {

class ImageObserver {
 public:
  virtual ~ImageObserver() = default;
  // Before the first instruction; `robot_id` as configured. Both outlive the time until ends().
  virtual void begins(mcu::McuFirmware& firmware, const mcu::ElfImage& image, std::uint32_t robot_id) = 0;
  virtual void ends(mcu::McuFirmware& firmware) = 0;
};

}  // namespace omnihil
