#include "protocols/dongles/table_dongle.h"

#include "protocols/dongles/plain_dongle.h"

namespace omnihil {

std::unique_ptr<RadioLink> make_table_dongle(const RadioFormat& format, const RadioLinkConfig& config) {
  PlainDongle plain;
  plain.half_frame_ns = 5'000'000;  // as the built-in ones
  plain.to_robot_ns = format.to_robot_ns;
  plain.to_host_ns = format.to_host_ns;
  return make_plain_dongle(format, config, plain);
}

}  // namespace omnihil
