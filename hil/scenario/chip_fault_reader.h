// The keys of steps that break the chip or set a variable, out of a scenario's file.
//
//   read_chip_fault(keys, table, "step[3]", fault);      // fault.kind is known; problems are in the keys' list
#pragma once
#include <string>

#include "firmware_iface/firmware_chip.h"
#include "hil/text/toml_keys.h"

namespace omnihil {

void read_chip_fault(TomlKeys& keys, const toml::table& t, const std::string& path, ChipFault& fault);
// A number, true, false, or the name of an enumerator, as text.
std::string value_text(TomlKeys& keys, const toml::table& t, const std::string& path);

}  // namespace omnihil
