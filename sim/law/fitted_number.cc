#include "sim/law/fitted_number.h"

#include <fmt/format.h>

#include "sim/law/toml_text.h"

namespace omnihil {
namespace {

std::string belief_text(std::optional<double> tolerance, const std::string& source) {
  std::string out;
  if (tolerance) out += fmt::format(", tolerance = {}", *tolerance);
  if (!source.empty()) out += ", source = " + toml_text(source);
  return out;
}

}  // namespace

std::string toml_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += std::string("\\") + c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string annotations_text(std::optional<double> tolerance, const NumberNote& note) {
  if (!note.fitted) return belief_text(tolerance, note.source);
  const FittedNumber& f = *note.fitted;
  std::string out;
  if (f.sigma) out += fmt::format(", sigma = {:.3g}", *f.sigma);
  out += fmt::format(", source = \"{}\"", kFittedSource);
  if (!f.data.empty()) out += ", data = " + toml_text(f.data);
  if (!f.date.empty()) out += ", date = " + toml_text(f.date);
  if (!f.believed) return out;
  out += fmt::format(", believed = {{ value = {}", *f.believed);
  if (!tolerance && f.believed_sigma) out += fmt::format(", sigma = {}", *f.believed_sigma);
  return out + belief_text(tolerance, note.source) + " }";
}

}  // namespace omnihil
