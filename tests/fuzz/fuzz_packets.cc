// libFuzzer: build with the preset `fuzz`, run `fuzz_packets tests/fuzz/corpus`.
#include "tests/fuzz/packet_property.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  omnihil::check_packet_property({data, size});
  return 0;
}
