// Packets of every radio format: packet_property.h says what must hold.
#include "tests/fuzz/packet_property.h"

OMNIHIL_FUZZ_TARGET(bytes) { omnihil::check_packet_property(bytes); }
