#include "hil/logs/log_formats.h"

namespace omnihil {
std::span<const BinaryLog> binary_logs() { return {}; }

}  // namespace omnihil
