// The FORMAT and PACKET arguments of the verbs: found, or explained on the error output.
#pragma once
#include <string>

#include "protocols/radio_format.h"

namespace omnihil {

// Null, after a message with the nearest spelling and all names, when there is none.
const RadioFormat* format_or_complain(const std::string& id);
// The format in a file, found by its id from now on; null, after a message for each problem, where there are any.
const RadioFormat* format_file_or_complain(const std::string& path);
// By its id or, where `file` is not empty, from there.
const RadioFormat* format_or_complain(const std::string& id, const std::string& file);
const Message* message_or_complain(const RadioFormat& format, const std::string& name);

}  // namespace omnihil
