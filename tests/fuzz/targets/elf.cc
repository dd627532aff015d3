// ELF images of emulated microcontrollers. Byte 0: bit 0 picks ARM or AVR.
#include "firmware_iface/mcu/machine/elf_image.h"
#include "tests/fuzz/fuzz_target.h"

OMNIHIL_FUZZ_TARGET(bytes) {
  using namespace omnihil;
  const auto machine = (take_byte(bytes) & 1U) != 0 ? mcu::ElfMachine::kAvr : mcu::ElfMachine::kArm;
  mcu::ElfImage image;
  std::vector<std::string> problems;
  const bool read = mcu::read_elf(bytes, image, problems, machine);
  demand(read == problems.empty(), "an image or a problem");
  std::size_t total = 0;
  for (const mcu::ElfSegment& segment : image.segments) total += segment.bytes.size();
  demand(!read || total > 0, "an image has bytes");
  image.function_at(image.entry);
}
