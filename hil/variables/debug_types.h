// Types out of DWARF entries, each once: debug_info.h's DebugType.
//
//   DebugTypes types;
//   int type = types.of(die);           // of what the entry's DW_AT_type names
#pragma once
#include <elfutils/libdw.h>

#include <deque>
#include <map>
#include <string>

#include "hil/variables/debug_info.h"

namespace omnihil {

// An attribute of an entry, or of the one that it completes; a number of either sign.
std::optional<std::uint64_t> number_of(Dwarf_Die* die, unsigned attribute);
std::string name_of(Dwarf_Die* die);
// What DW_AT_type names. False: nothing.
bool type_die_of(Dwarf_Die* die, Dwarf_Die* out);

class DebugTypes {
 public:
  int of(Dwarf_Die* die);        // of the entry's type; -1: it has none
  int made_from(Dwarf_Die die);  // of this type itself
  const DebugType& operator[](int index) const { return types_.at(static_cast<std::size_t>(index)); }

 private:
  int of_peeled(Dwarf_Die die);
  DebugType scalar(Dwarf_Die* die) const;
  DebugType enumeration(Dwarf_Die* die) const;
  DebugType structure(Dwarf_Die* die);
  void add_member(Dwarf_Die* child, DebugType& type);
  int array(Dwarf_Die* die);

  std::deque<DebugType> types_;       // references stay
  std::map<const void*, int> known_;  // by the entry's place in the file
  int depth_ = 0;
};

}  // namespace omnihil
