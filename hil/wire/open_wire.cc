#include "hil/wire/open_wire.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "sim/law/spelling.h"

namespace omnihil {
namespace {

bool fits(const WireKind& kind, WireForm form) {
  if (form == WireForm::kEither) return true;
  return form == WireForm::kBytes ? kind.open_bytes != nullptr : kind.open_frames != nullptr;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string_view>& known) {
  const std::string_view nearest = nearest_spelling(word, known);
  return nearest.empty() ? "" : fmt::format(", did you mean {}?", nearest);
}

void check_parameters(const WireUrl& url, const WireKind& kind, std::vector<std::string>& problems) {
  std::vector<std::string_view> known;
  for (const WireParameter& each : kind.parameters) known.push_back(each.name);
  for (std::size_t i = 0; i < url.query.size(); ++i) {
    const auto& [name, value] = url.query[i];
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) {
      problems.push_back(fmt::format("{}: \"{}\" is no parameter of {}{}; allowed: {}", url.text(), name,
                                     kind.scheme, did_you_mean(name, known),
                                     known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", "))));
      continue;
    }
    const WireParameter& parameter = kind.parameters[static_cast<std::size_t>(found - known.begin())];
    if (url.find(name) != &value) problems.push_back(fmt::format("{}: {} stands twice", url.text(), name));
    if (!parameter.allows(value)) {
      problems.push_back(
          fmt::format("{}: {} \"{}\"; allowed: {}", url.text(), parameter.says, value, parameter.allowed()));
    }
  }
}

// The URL with every parameter of its kind: as given, as this use has it, as usual.
WireUrl filled_in(const WireUrl& url, const WireKind& kind, const WireQuery& usual) {
  WireUrl full = url;
  const WireUrl of_use{.scheme = {}, .address = {}, .query = usual};
  for (const WireParameter& parameter : kind.parameters) {
    if (url.find(parameter.name) != nullptr) continue;
    const std::string* value = of_use.find(parameter.name);
    full.query.emplace_back(parameter.name, value != nullptr ? *value : std::string(parameter.usual));
  }
  return full;
}

template <class Wire>
std::unique_ptr<Wire> opened(std::unique_ptr<Wire> (*WireKind::*open)(const WireUrl&, WireProblem&),
                             WireForm form, const WireUrl& url, const WireQuery& usual,
                             WireProblem& problem) {
  problem = {};
  const std::vector<std::string> problems = wire_problems(url, form);
  if (!problems.empty()) {
    problem.what = fmt::format("{}", fmt::join(problems, "\n"));
    return nullptr;
  }
  const WireKind& kind = *find_wire_kind(url.scheme);
  return (kind.*open)(filled_in(url, kind, usual), problem);
}

}  // namespace

bool WireParameter::allows(std::string_view value) const {
  if (!words.empty()) return std::find(words.begin(), words.end(), value) != words.end();
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  return error == std::errc{} && end == value.data() + value.size() && number >= low && number <= high;
}

std::string WireParameter::allowed() const {
  return words.empty() ? fmt::format("{} to {}", low, high) : fmt::format("{}", fmt::join(words, ", "));
}

const WireKind* find_wire_kind(std::string_view scheme) {
  for (const WireKind* kind : wire_kinds()) {
    if (kind->scheme == scheme) return kind;
  }
  return nullptr;
}

std::string known_wires(WireForm form) {
  std::vector<std::string> known;
  for (const WireKind* kind : wire_kinds()) {
    if (fits(*kind, form)) known.push_back(std::string(kind->scheme) + ":");
  }
  return fmt::format("{}", fmt::join(known, ", "));
}

std::vector<std::string> wire_problems(const WireUrl& url, WireForm form) {
  const WireKind* kind = find_wire_kind(url.scheme);
  if (kind == nullptr && url.scheme.empty()) {
    return {fmt::format("\"{}\" names no wire; known: {}", url.address, known_wires(form))};
  }
  if (kind == nullptr) {
    std::vector<std::string_view> known;
    for (const WireKind* each : wire_kinds()) known.push_back(each->scheme);
    return {fmt::format("{}: \"{}\" is no wire{}; known: {} (a file of that name: ./{})", url.text(),
                        url.scheme, did_you_mean(url.scheme, known), known_wires(form), url.text())};
  }
  if (!fits(*kind, form)) {
    return {fmt::format("{}: carries {}; needed: {}", url.text(),
                        form == WireForm::kBytes ? "frames" : "bytes", known_wires(form))};
  }
  std::vector<std::string> problems;
  if (url.address.empty()) {
    problems.push_back(fmt::format("\"{}\": no {}; such as {}", url.text(), kind->address, kind->example));
  }
  check_parameters(url, *kind, problems);
  return problems;
}

std::unique_ptr<ByteWire> open_byte_wire(const WireUrl& url, const WireQuery& usual, WireProblem& problem) {
  return opened(&WireKind::open_bytes, WireForm::kBytes, url, usual, problem);
}

std::unique_ptr<FrameWire> open_frame_wire(const WireUrl& url, const WireQuery& usual, WireProblem& problem) {
  return opened(&WireKind::open_frames, WireForm::kFrames, url, usual, problem);
}

}  // namespace omnihil
