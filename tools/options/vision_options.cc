#include "tools/options/vision_options.h"

#include <fmt/format.h>

#include <charconv>
#include <stdexcept>
#include <system_error>

namespace omnihil {
namespace {

constexpr const char* kGroup = "224.5.23.2";  // of SSL-Vision
constexpr int kPort = 10006;

}  // namespace

void add_vision_options(Verb& verb, VisionWords& words) {
  verb.add_option("--vision", words.group,
                  "hear SSL-Vision too: multicast GROUP:PORT, or on for 224.5.23.2:10006");
  verb.add_option("--vision-interface", words.interface, "address of the network interface that hears it")
      .capture_default_str();
}

std::optional<UdpPort> open_vision(const VisionWords& words) {
  if (words.group.empty()) return std::nullopt;
  std::string group = kGroup, error;
  int port = kPort;
  if (words.group != "on") {
    const std::size_t colon = words.group.find(':');
    const std::string number = colon == std::string::npos ? "" : words.group.substr(colon + 1);
    const auto [end, problem] = std::from_chars(number.data(), number.data() + number.size(), port);
    if (number.empty() || problem != std::errc{} || end != number.data() + number.size() || port < 1 ||
        port > 65535)
      throw std::invalid_argument(fmt::format(
          "--vision: found \"{}\", allowed: on, or GROUP:PORT such as 224.5.23.2:10006", words.group));
    group = words.group.substr(0, colon);
  }
  UdpPort out = UdpPort::join(group, port, words.interface, error);
  if (!out.is_open())
    throw std::system_error(std::make_error_code(std::errc::io_error), "--vision: " + error);
  return out;
}

}  // namespace omnihil
