// A terminal as a line for bytes: raw, 8 bits, no echo, no flow control, modem lines ignored.
#pragma once

namespace omnihil {

bool make_raw(int fd);  // false: errno says why

}  // namespace omnihil
