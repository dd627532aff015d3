#include "hil/variables/debug_lines.h"

#include <elfutils/libdw.h>
#include <gelf.h>

#include <algorithm>

namespace omnihil {
namespace {

constexpr std::size_t kMostRows = 1u << 22;  // more is a broken file

using Ranges = std::vector<std::pair<std::uint64_t, std::uint64_t>>;

Ranges code_of(Elf* elf) {
  Ranges ranges;
  Elf_Scn* section = nullptr;
  while ((section = elf_nextscn(elf, section)) != nullptr) {
    GElf_Shdr head;
    if (gelf_getshdr(section, &head) == nullptr || (head.sh_flags & SHF_EXECINSTR) == 0) continue;
    ranges.emplace_back(head.sh_addr, head.sh_addr + head.sh_size);
  }
  return ranges;
}

bool within(const Ranges& ranges, std::uint64_t address) {
  return std::ranges::any_of(ranges, [&](const auto& r) { return address >= r.first && address < r.second; });
}

void add_unit(Dwarf_Die* unit, const Ranges& code, std::vector<DebugLine>& rows) {
  Dwarf_Lines* lines = nullptr;
  std::size_t count = 0;
  if (dwarf_getsrclines(unit, &lines, &count) != 0) return;
  for (std::size_t i = 0; i + 1 < count && rows.size() < kMostRows; ++i) {
    Dwarf_Line* here = dwarf_onesrcline(lines, i);
    Dwarf_Line* next = dwarf_onesrcline(lines, i + 1);
    Dwarf_Addr begin = 0, end = 0;
    bool ends = false, statement = false;
    int line = 0;
    const char* file = dwarf_linesrc(here, nullptr, nullptr);
    if (file == nullptr || dwarf_lineaddr(here, &begin) != 0 || dwarf_lineaddr(next, &end) != 0) continue;
    if (dwarf_lineendsequence(here, &ends) != 0 || ends || dwarf_lineno(here, &line) != 0 || line <= 0)
      continue;
    dwarf_linebeginstatement(here, &statement);
    if (end > begin && within(code, begin)) rows.push_back({begin, end, file, line, statement});
  }
}

}  // namespace

std::vector<DebugLine> read_lines(std::vector<std::uint8_t> bytes) {
  std::vector<DebugLine> rows;
  elf_version(EV_CURRENT);
  Elf* elf = elf_memory(reinterpret_cast<char*>(bytes.data()), bytes.size());
  Dwarf* dwarf = elf != nullptr ? dwarf_begin_elf(elf, DWARF_C_READ, nullptr) : nullptr;
  if (dwarf != nullptr) {
    const Ranges code = code_of(elf);
    Dwarf_CU* unit = nullptr;
    Dwarf_Die die, split;
    std::uint8_t kind = 0;
    while (dwarf_get_units(dwarf, unit, &unit, nullptr, &kind, &die, &split) == 0) add_unit(&die, code, rows);
    dwarf_end(dwarf);
  }
  if (elf != nullptr) elf_end(elf);
  std::ranges::stable_sort(rows, {}, &DebugLine::begin);
  return rows;
}

}  // namespace omnihil
