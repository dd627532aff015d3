// Radio formats as files. One that is taken decodes, encodes and serves whatever bytes come (packets.cc's property).
#include "hil/radio_file/radio_file.h"
#include "protocols/radio_link.h"
#include "tests/fuzz/packet_property.h"

namespace omnihil {
namespace {

struct Nobody final : RadioSink {
  void deliver(const Delivery&, std::int64_t) override {}
};

}  // namespace
}  // namespace omnihil

OMNIHIL_FUZZ_TARGET(bytes) {
  using namespace omnihil;
  const RadioFile file = read_radio_file(text_of(bytes), "fuzz.toml");
  demand((file.format != nullptr) == file.problems.empty(), "a format or a problem");
  for (const ModelProblem& problem : file.problems) demand(!problem.text().empty(), "a problem has words");
  if (file.format == nullptr) return;
  for (const std::size_t size : {4U, 9U, 17U, 40U}) {
    check_frame(*file.format, bytes.first(std::min(size, bytes.size())));
    check_contents(*file.format, bytes.first(std::min(size, bytes.size())));
  }
  RadioLinkConfig config;
  config.robot_ids = {0};
  const auto link = file.format->make_link(config);
  Nobody nobody;
  link->host_bytes(bytes, 0);
  link->poll(1'000'000, nobody);
}
