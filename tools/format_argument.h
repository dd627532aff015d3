// The FORMAT and PACKET arguments of the verbs: found, or explained on the error output.
#pragma once
#include <string>

#include "protocols/radio_format.h"

namespace omnihil {

// Null, after a message with the nearest spelling and all names, when there is none.
const RadioFormat* format_or_complain(const std::string& id);
const Message* message_or_complain(const RadioFormat& format, const std::string& name);

}  // namespace omnihil
