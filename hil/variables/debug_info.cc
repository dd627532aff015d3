#include "hil/variables/debug_info.h"

#include <dwarf.h>
#include <elfutils/libdw.h>
#include <fmt/format.h>
#include <gelf.h>

#include <algorithm>
#include <cstring>

#include "hil/variables/avr_space.h"
#include "hil/variables/debug_types.h"

namespace omnihil {
namespace {

constexpr int kDeepestScope = 64;
constexpr const char* kStabs = "has debug information as stabs, which is not read: compile it with -gdwarf-4";
constexpr std::size_t kMostVariables = 1u << 20;  // more is a broken file

struct Section {
  std::uint64_t begin = 0, bytes = 0;
  bool writable = false, in_file = false;
  std::uint64_t offset = 0;
};

std::string without_folders(const std::string& path) { return path.substr(path.find_last_of("/\\") + 1); }

class Dwarfs final : public DebugInfo {
 public:
  explicit Dwarfs(std::vector<std::uint8_t> bytes) : bytes_(std::move(bytes)) {}
  ~Dwarfs() override {
    if (dwarf_ != nullptr) dwarf_end(dwarf_);
    if (elf_ != nullptr) elf_end(elf_);
  }
  Dwarfs(const Dwarfs&) = delete;
  Dwarfs& operator=(const Dwarfs&) = delete;

  std::string open();
  const std::vector<DebugVariable>& variables() const override { return variables_; }
  const DebugType& type(int index) const override { return types_[index]; }
  const std::map<std::string, DebugLocal, std::less<>>& locals() const override { return locals_; }
  std::optional<int> struct_named(std::string_view name) const override;
  std::vector<int> structs_of(std::uint64_t bytes) const override;
  std::vector<std::uint8_t> initial(std::uint64_t address, std::uint64_t bytes) const override;

 private:
  struct Scope {
    std::string name;      // "robot::Wheel"
    std::string function;  // that it lies in; empty: none
    int depth = 0;
  };
  void read_sections();
  bool only_stabs() const;
  void walk(Dwarf_Die* parent, const Scope& scope, const std::string& file);
  void entry(Dwarf_Die* die, const Scope& scope, const std::string& file);
  void variable(Dwarf_Die* die, const Scope& scope, const std::string& file);
  bool locate(Dwarf_Die* die, DebugVariable& variable) const;
  void locate_by(Dwarf_Attribute* location, DebugVariable& variable) const;
  void take_constant(Dwarf_Attribute* value, DebugVariable& variable) const;
  const Section* section_of(std::uint64_t address, std::uint64_t bytes) const;
  void note_struct(Dwarf_Die* die, const std::string& name);
  void sort();

  std::vector<std::uint8_t> bytes_;
  Elf* elf_ = nullptr;
  Dwarf* dwarf_ = nullptr;
  std::vector<Section> sections_;
  std::optional<AvrSpace> avr_;  // of an AVR's file
  bool stabs_ = false;
  mutable DebugTypes types_;
  std::vector<DebugVariable> variables_;
  std::map<std::string, DebugLocal, std::less<>> locals_;
  std::map<const void*, std::string> declared_;  // members that are defined elsewhere, by their full name
  std::map<std::string, Dwarf_Die, std::less<>> structs_;
  std::map<std::uint64_t, std::vector<Dwarf_Die>> structs_by_size_;
};

std::string Dwarfs::open() {
  elf_version(EV_CURRENT);
  elf_ = elf_memory(reinterpret_cast<char*>(bytes_.data()), bytes_.size());
  if (elf_ == nullptr || elf_kind(elf_) != ELF_K_ELF) {
    return !bytes_.empty() && bytes_[0] == ':'
               ? "Intel HEX has no names: give the ELF file that it was made from"
               : "is no ELF file";
  }
  read_sections();
  avr_ = AvrSpace::of(elf_);
  dwarf_ = dwarf_begin_elf(elf_, DWARF_C_READ, nullptr);
  if (dwarf_ == nullptr && stabs_) return kStabs;
  if (dwarf_ == nullptr) return "has no debug information: compile and link it with -g, and do not strip it";
  Dwarf_CU* unit = nullptr;
  Dwarf_Die die, split;
  std::uint8_t kind = 0;
  int units = 0;
  while (dwarf_get_units(dwarf_, unit, &unit, nullptr, &kind, &die, &split) == 0) {
    if (kind != DW_UT_compile && kind != DW_UT_partial) continue;
    ++units;
    walk(&die, {}, without_folders(name_of(&die)));
  }
  if (only_stabs()) return kStabs;
  if (units == 0) return "has no debug information: compile and link it with -g, and do not strip it";
  sort();
  return {};
}

// avr-gcc says stabs with a plain -g, beside some DWARF of avr-libc's own.
bool Dwarfs::only_stabs() const {
  return stabs_ && std::ranges::none_of(variables_, [](const DebugVariable& v) { return v.why_not.empty(); });
}

void Dwarfs::read_sections() {
  std::size_t names = 0;
  elf_getshdrstrndx(elf_, &names);
  Elf_Scn* section = nullptr;
  while ((section = elf_nextscn(elf_, section)) != nullptr) {
    GElf_Shdr head;
    if (gelf_getshdr(section, &head) == nullptr) continue;
    const char* name = elf_strptr(elf_, names, head.sh_name);
    stabs_ = stabs_ || (name != nullptr && std::string_view(name) == ".stab");
    if ((head.sh_flags & SHF_ALLOC) == 0 || head.sh_size == 0) continue;
    if ((head.sh_flags & SHF_TLS) != 0) continue;
    sections_.push_back({head.sh_addr, head.sh_size, (head.sh_flags & SHF_WRITE) != 0,
                         head.sh_type != SHT_NOBITS, head.sh_offset});
  }
}

const Section* Dwarfs::section_of(std::uint64_t address, std::uint64_t bytes) const {
  for (const Section& s : sections_) {
    if (address >= s.begin && address - s.begin < s.bytes && bytes <= s.bytes - (address - s.begin))
      return &s;
  }
  return nullptr;
}

std::vector<std::uint8_t> Dwarfs::initial(std::uint64_t address, std::uint64_t bytes) const {
  const Section* s = section_of(address, bytes);
  if (s == nullptr || !s->in_file) return {};
  const std::uint64_t at = s->offset + (address - s->begin);
  if (at > bytes_.size() || bytes > bytes_.size() - at) return {};
  const auto begin = bytes_.begin() + static_cast<std::ptrdiff_t>(at);
  return {begin, begin + static_cast<std::ptrdiff_t>(bytes)};
}

void Dwarfs::walk(Dwarf_Die* parent, const Scope& scope, const std::string& file) {
  if (scope.depth > kDeepestScope) return;
  Dwarf_Die child;
  if (dwarf_child(parent, &child) != 0) return;
  do {
    if (variables_.size() >= kMostVariables) return;
    entry(&child, scope, file);
  } while (dwarf_siblingof(&child, &child) == 0);
}

void Dwarfs::entry(Dwarf_Die* die, const Scope& scope, const std::string& file) {
  Scope inner = scope;
  ++inner.depth;
  const auto enter = [&](const std::string& name) {
    if (!name.empty()) inner.name += (inner.name.empty() ? "" : "::") + name;
  };
  switch (dwarf_tag(die)) {
    case DW_TAG_variable:
      variable(die, scope, file);
      return;
    case DW_TAG_formal_parameter:
      locals_.emplace(name_of(die), DebugLocal{scope.function});
      return;
    case DW_TAG_member:
      declared_[die->addr] = scope.name + "::" + name_of(die);
      return;
    case DW_TAG_namespace:
      enter(name_of(die));
      return walk(die, inner, file);
    case DW_TAG_subprogram:
      inner.function = name_of(die);
      enter(inner.function);
      return walk(die, inner, file);
    case DW_TAG_lexical_block:
    case DW_TAG_inlined_subroutine:
    case DW_TAG_try_block:
    case DW_TAG_catch_block:
      return walk(die, inner, file);
    case DW_TAG_typedef: {
      Dwarf_Die target;
      if (type_die_of(die, &target)) note_struct(&target, name_of(die));
      return;
    }
    case DW_TAG_structure_type:
    case DW_TAG_class_type:
    case DW_TAG_union_type:
      enter(name_of(die));
      note_struct(die, inner.name);
      return walk(die, inner, file);
    default:
      return;
  }
}

void Dwarfs::note_struct(Dwarf_Die* die, const std::string& name) {
  const int tag = dwarf_tag(die);
  if (tag != DW_TAG_structure_type && tag != DW_TAG_class_type) return;
  const auto bytes = number_of(die, DW_AT_byte_size);
  if (name.empty() || !bytes) return;
  if (structs_.emplace(name, *die).second) structs_by_size_[*bytes].push_back(*die);
}

std::optional<int> Dwarfs::struct_named(std::string_view name) const {
  const auto found = structs_.find(name);
  if (found == structs_.end()) return std::nullopt;
  const int type = types_.made_from(found->second);
  return type >= 0 ? std::optional(type) : std::nullopt;
}

std::vector<int> Dwarfs::structs_of(std::uint64_t bytes) const {
  std::vector<int> found;
  const auto of_size = structs_by_size_.find(bytes);
  if (of_size == structs_by_size_.end()) return found;
  std::vector<std::string> names;
  for (const Dwarf_Die& die : of_size->second) {
    const int type = types_.made_from(die);
    if (type < 0 || std::ranges::find(names, types_[type].name) != names.end()) continue;
    names.push_back(types_[type].name);  // each unit that includes the header has it once
    found.push_back(type);
  }
  return found;
}

void Dwarfs::variable(Dwarf_Die* die, const Scope& scope, const std::string& file) {
  const std::string name = name_of(die);
  if (name.empty()) return;
  const std::string here = scope.name.empty() ? name : scope.name + "::" + name;
  if (dwarf_hasattr(die, DW_AT_declaration) != 0) {
    declared_[die->addr] = here;
    return;
  }
  DebugVariable v;
  v.name = here;
  v.file = file;
  Dwarf_Attribute completes;
  Dwarf_Die declaration;
  if (dwarf_attr(die, DW_AT_specification, &completes) != nullptr &&
      dwarf_formref_die(&completes, &declaration) != nullptr) {
    const auto known = declared_.find(declaration.addr);
    if (known != declared_.end()) v.name = known->second;
  }
  v.type = types_.of(die);
  const bool is_static = locate(die, v);
  if (!scope.function.empty() && !is_static && v.constant.empty()) {
    locals_.emplace(name, DebugLocal{scope.function});
    return;
  }
  if (v.type < 0 || types_[v.type].bytes == 0) v.why_not = "has a type that is not read";
  variables_.push_back(std::move(v));
}

// Whether it is one with an address at all, be it one that is no variable's.
bool Dwarfs::locate(Dwarf_Die* die, DebugVariable& v) const {
  Dwarf_Attribute location, value;
  if (dwarf_attr_integrate(die, DW_AT_location, &location) != nullptr) {
    locate_by(&location, v);
  } else if (dwarf_attr_integrate(die, DW_AT_const_value, &value) != nullptr) {
    take_constant(&value, v);
  } else {
    v.why_not = "was removed by the optimiser: it has no place in memory";
  }
  if (!v.address || v.type < 0) return v.address.has_value();
  if (avr_) v.why_not = avr_->why_no_data(*v.address);
  if (!v.why_not.empty()) {
    v.address.reset();
    return true;
  }
  const Section* section = section_of(*v.address, std::max<std::uint64_t>(1, types_[v.type].bytes));
  v.writable = section != nullptr && section->writable;
  if (section != nullptr || sections_.empty()) return true;
  v.address.reset();
  v.why_not = "was removed by the linker: nothing that is linked refers to it";
  return true;
}

void Dwarfs::locate_by(Dwarf_Attribute* location, DebugVariable& v) const {
  Dwarf_Op* ops = nullptr;
  std::size_t count = 0;
  if (dwarf_getlocation(location, &ops, &count) != 0 || count == 0) {
    v.why_not = "was removed by the optimiser: it has no place in memory";
    return;
  }
  const auto says = [&](std::size_t i, unsigned atom) { return i < count && ops[i].atom == atom; };
  for (std::size_t i = 0; i < count; ++i) {
    if (says(i, DW_OP_GNU_push_tls_address) || says(i, DW_OP_form_tls_address)) {
      v.why_not = "is thread-local";
      return;
    }
  }
  std::optional<std::uint64_t> address;
  if (says(0, DW_OP_addr)) address = ops[0].number;
  if (says(0, DW_OP_addrx) || says(0, DW_OP_GNU_addr_index)) {
    Dwarf_Attribute indexed;
    Dwarf_Addr value = 0;
    if (dwarf_getlocation_attr(location, &ops[0], &indexed) == 0 && dwarf_formaddr(&indexed, &value) == 0)
      address = value;
  }
  if (address && count == 2 && says(1, DW_OP_plus_uconst)) {
    v.address = *address + ops[1].number;
  } else if (address && count == 1) {
    v.address = address;
  } else {
    v.why_not = "was taken to pieces by the optimiser: it has no single place in memory";
  }
}

void Dwarfs::take_constant(Dwarf_Attribute* value, DebugVariable& v) const {
  const std::uint64_t bytes = v.type >= 0 ? types_[v.type].bytes : 0;
  const unsigned form = dwarf_whatform(value);
  Dwarf_Block block;
  if (form == DW_FORM_block || form == DW_FORM_block1 || form == DW_FORM_block2 || form == DW_FORM_block4) {
    if (dwarf_formblock(value, &block) == 0 && block.length == bytes)
      v.constant.assign(block.data, block.data + block.length);
  } else if (bytes <= 8) {
    Dwarf_Sword with_sign = 0;
    Dwarf_Word word = 0;
    const bool is_signed = form == DW_FORM_sdata || form == DW_FORM_implicit_const;
    if (is_signed ? dwarf_formsdata(value, &with_sign) == 0 : dwarf_formudata(value, &word) == 0) {
      if (is_signed) word = static_cast<Dwarf_Word>(with_sign);
      v.constant.resize(bytes);
      std::memcpy(v.constant.data(), &word, bytes);
    }
  }
  if (v.constant.empty()) v.why_not = "was made a constant by the optimiser, which does not say which";
}

// By name; the same one of several units (a header's) once; one that has a place before one that has none.
void Dwarfs::sort() {
  std::ranges::stable_sort(variables_, [](const DebugVariable& a, const DebugVariable& b) {
    return std::pair(a.name, a.why_not.empty() ? 0 : 1) < std::pair(b.name, b.why_not.empty() ? 0 : 1);
  });
  const auto same = [](const DebugVariable& a, const DebugVariable& b) {
    return a.name == b.name && (a.address == b.address ? a.constant == b.constant : !b.why_not.empty());
  };
  variables_.erase(std::unique(variables_.begin(), variables_.end(), same), variables_.end());
}

}  // namespace

std::shared_ptr<const DebugInfo> DebugInfo::read(std::vector<std::uint8_t> bytes, std::string& problem) {
  auto info = std::make_shared<Dwarfs>(std::move(bytes));
  problem = info->open();
  return problem.empty() ? info : nullptr;
}

}  // namespace omnihil
