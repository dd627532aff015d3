// What of an image ran, how often, and what it cost, over as many runs as one likes: lines, functions with their callers,
// interrupts.
//
//   auto profile = std::make_shared<ImageProfile>();
//   FirmwareChoice choice{.file = "fw.elf", .board = "mine.toml", .observer = profile};
//   …                                                              // one scenario after another
//   write(lcov_text(*profile, read_lines(bytes)));       // profile_text.h
//
// All boards and robots that it watches count together. An instruction whose IT block's condition did not hold has not
// run. Cycles are the emulator's (docs/mcu-core.md).
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hil/firmware/image_observer.h"

namespace omnihil {

struct FunctionCost {
  std::uint64_t calls = 0;
  std::int64_t self = 0, inclusive = 0;  // in 16ths of a cycle; inclusive: with callees, without interrupts
};

struct CallCost {
  std::uint64_t calls = 0;
  std::int64_t inclusive = 0;
};

struct InterruptCost {
  std::uint64_t count = 0;
  std::int64_t longest =
      0;  // from its first instruction to its last, interruptions included, in 16ths of a cycle
  std::uint32_t stack_bytes =
      0;  // the most below where it began, of interruptions too; its frame is 32 bytes or more above
};

class ImageProfile final : public ImageObserver {
 public:
  ImageProfile();
  ~ImageProfile() override;
  void begins(mcu::McuFirmware& firmware, const mcu::ElfImage& image, std::uint32_t robot_id) override;
  void ends(mcu::McuFirmware& firmware) override;

  // How often the instruction at an address ran.
  std::uint64_t runs_of(std::uint32_t address) const;
  const std::map<std::string, FunctionCost>& functions() const { return functions_; }
  const std::map<std::pair<std::string, std::string>, CallCost>& calls() const {
    return calls_;
  }  // caller, callee
  const std::map<int, InterruptCost>& interrupts() const { return interrupts_; }
  // All functions of the image, by address, whether they ran or not.
  const std::map<std::uint32_t, std::string>& image_functions() const { return image_functions_; }
  std::int64_t asleep() const { return asleep_; }

 private:
  class Board;
  friend class Board;
  std::vector<std::pair<mcu::McuFirmware*, std::unique_ptr<Board>>> boards_;
  std::map<std::uint32_t, std::vector<std::uint64_t>>
      counts_;  // by the begin of what the image loads, a halfword each
  std::map<std::string, FunctionCost> functions_;
  std::map<std::pair<std::string, std::string>, CallCost> calls_;
  std::map<int, InterruptCost> interrupts_;
  std::map<std::uint32_t, std::string> image_functions_;
  std::int64_t asleep_ = 0;
};

}  // namespace omnihil
