// The dongle of a format that comes from a file: a plain one, what packets ask and answers say by their fields' meaning.
//
//   RadioFormat from_file;
//   from_file.dongle = make_table_dongle;
//
// Cannot: several robots in one packet, answers of the dongle itself, retries, hosts that are told from robots by more
// than the tables. Those need a file under teams/.
#pragma once
#include "protocols/radio_format.h"

namespace omnihil {

std::unique_ptr<RadioLink> make_table_dongle(const RadioFormat& format, const RadioLinkConfig& config);

}  // namespace omnihil
