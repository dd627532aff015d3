#include "hil/variables/avr_space.h"

#include <algorithm>

namespace omnihil {
namespace {
constexpr std::uint64_t kData = 0x800000, kEeprom = 0x810000, kFuses = 0x820000;
}  // namespace

std::optional<AvrSpace> AvrSpace::of(Elf* elf) {
  GElf_Ehdr head;
  if (gelf_getehdr(elf, &head) == nullptr || head.e_machine != EM_AVR) return std::nullopt;
  AvrSpace space;
  space.data_begin_ = kEeprom;
  Elf_Scn* section = nullptr;
  while ((section = elf_nextscn(elf, section)) != nullptr) {
    GElf_Shdr part;
    if (gelf_getshdr(section, &part) == nullptr) continue;
    if ((part.sh_flags & SHF_ALLOC) != 0 && part.sh_size > 0 && part.sh_addr >= kData)
      space.data_begin_ = std::min(space.data_begin_, part.sh_addr);
    Elf_Data* symbols = part.sh_type == SHT_SYMTAB ? elf_getdata(section, nullptr) : nullptr;
    GElf_Sym symbol;
    for (int i = 0; symbols != nullptr && gelf_getsym(symbols, i, &symbol) != nullptr; ++i) {
      if (GELF_ST_TYPE(symbol.st_info) == STT_OBJECT && symbol.st_value < kData)
        space.objects_.insert(symbol.st_value);
    }
  }
  return space;
}

// What the linker left out is at 0 or close to it, where flash has vectors and no object.
std::string AvrSpace::why_no_data(std::uint64_t address) const {
  if (address >= kFuses) return "lies in fuses, lock bits or signature, which are not read";
  if (address >= kEeprom) return "lies in the EEPROM, which is not read";
  if (address >= data_begin_) return {};
  if (address >= kData) return "is a register of the chip, no variable";
  return objects_.contains(address) ? "lies in flash (PROGMEM), which is not read"
                                    : "was removed by the linker: nothing that is linked refers to it";
}

}  // namespace omnihil
