#include "hil/wire/wire_url.h"

#include <algorithm>

namespace omnihil {
namespace {

std::vector<std::string> split(std::string_view text, char at) {
  std::vector<std::string> parts;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t end = std::min(text.find(at, from), text.size());
    parts.emplace_back(text.substr(from, end - from));
    from = end + 1;
  }
  return parts;
}

void read_query(std::string_view text, WireQuery& query) {
  for (const std::string& part : split(text, '&')) {
    const std::size_t equals = std::min(part.find('='), part.size());
    query.emplace_back(part.substr(0, equals), part.substr(std::min(equals + 1, part.size())));
  }
}

void mend_old_spelling(WireUrl& url) {
  if (url.scheme == "canfd") {
    url.scheme = "can";
    url.query.emplace_back("fd", "1");
  }
  const std::size_t comma = url.address.find(',');
  if (url.scheme == "serial" && comma != std::string::npos) {
    url.query.emplace_back("baud", url.address.substr(comma + 1));
    url.address.resize(comma);
  }
}

}  // namespace

std::string WireUrl::text() const {
  std::string out = scheme + ":" + address;
  char separator = '?';
  for (const auto& [name, value] : query) {
    out += separator + name + "=" + value;
    separator = '&';
  }
  return out;
}

const std::string* WireUrl::find(std::string_view parameter) const {
  const auto it =
      std::find_if(query.begin(), query.end(), [&](const auto& each) { return each.first == parameter; });
  return it == query.end() ? nullptr : &it->second;
}

int WireUrl::number(std::string_view parameter) const { return std::stoi(word(parameter)); }

bool looks_like_wire(std::string_view text) {
  const std::size_t colon = text.find(':');
  return colon != std::string_view::npos && colon > 0 &&
         std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(colon),
                     [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); });
}

WireUrl read_wire_url(const std::string& text, std::string_view scheme_of_bare_path) {
  WireUrl url;
  if (!looks_like_wire(text)) {
    url.scheme = scheme_of_bare_path;
    url.address = text;
    return url;
  }
  const std::size_t colon = text.find(':');
  const std::size_t mark = std::min(text.find('?', colon), text.size());
  url.scheme = text.substr(0, colon);
  url.address = text.substr(colon + 1, mark - colon - 1);
  if (mark < text.size()) read_query(std::string_view(text).substr(mark + 1), url.query);
  mend_old_spelling(url);
  return url;
}

std::vector<WireUrl> read_motor_wires(const std::string& text, int motors) {
  constexpr std::string_view kUart = "uart:", kSerial = "serial:", kMotor = "{motor}";
  std::vector<WireUrl> wires;
  if (text.starts_with(kSerial) && text.find(',') != std::string::npos) {
    for (const std::string& device : split(std::string_view(text).substr(kSerial.size()), ','))
      wires.push_back(read_wire_url(std::string(kSerial) + device));
    return wires;
  }
  const std::string each =
      text.starts_with(kUart) ? "pty:" + text.substr(kUart.size()) + std::string(kMotor) : text;
  if (each.find(kMotor) == std::string::npos) return wires;
  for (int m = 0; m < motors; ++m)
    wires.push_back(read_wire_url(with_number(each, kMotor, static_cast<std::uint32_t>(m))));
  return wires;
}

std::string with_number(std::string text, std::string_view place, std::uint32_t number) {
  for (std::size_t at; (at = text.find(place)) != std::string::npos;)
    text.replace(at, place.size(), std::to_string(number));
  return text;
}

}  // namespace omnihil
