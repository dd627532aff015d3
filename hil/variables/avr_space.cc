#include "hil/variables/avr_space.h"

#include <algorithm>

#include "firmware_iface/mcu/avr/avr_image.h"

namespace omnihil {
using mcu::kAvrData, mcu::kAvrEeprom, mcu::kAvrFuses;

std::optional<AvrSpace> AvrSpace::of(Elf* elf) {
  GElf_Ehdr head;
  if (gelf_getehdr(elf, &head) == nullptr || head.e_machine != EM_AVR) return std::nullopt;
  AvrSpace space;
  space.data_begin_ = kAvrEeprom;
  Elf_Scn* section = nullptr;
  while ((section = elf_nextscn(elf, section)) != nullptr) {
    GElf_Shdr part;
    if (gelf_getshdr(section, &part) == nullptr) continue;
    if ((part.sh_flags & SHF_ALLOC) != 0 && part.sh_size > 0 && part.sh_addr >= kAvrData)
      space.data_begin_ = std::min(space.data_begin_, part.sh_addr);
    Elf_Data* symbols = part.sh_type == SHT_SYMTAB ? elf_getdata(section, nullptr) : nullptr;
    GElf_Sym symbol;
    for (int i = 0; symbols != nullptr && gelf_getsym(symbols, i, &symbol) != nullptr; ++i) {
      if (GELF_ST_TYPE(symbol.st_info) == STT_OBJECT && symbol.st_value < kAvrData)
        space.objects_.insert(symbol.st_value);
    }
  }
  return space;
}

// What the linker left out is at 0 or close to it, where flash has vectors and no object.
std::string AvrSpace::why_no_data(std::uint64_t address) const {
  if (address >= kAvrFuses) return "lies in fuses, lock bits or signature, which are not read";
  if (address >= kAvrEeprom) return "lies in the EEPROM, which is not read";
  if (address >= data_begin_) return {};
  if (address >= kAvrData) return "is a register of the chip, no variable";
  return objects_.contains(address) ? "lies in flash (PROGMEM), which is not read"
                                    : "was removed by the linker: nothing that is linked refers to it";
}

}  // namespace omnihil
