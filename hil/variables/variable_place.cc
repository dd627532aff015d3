#include "hil/variables/variable_place.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

#include "sim/law/spelling.h"

namespace omnihil {
namespace {

constexpr std::size_t kMostNamed = 8;  // in a message

// Where the variable's own name ends: at a '.' or '[' outside of <…> and (…).
std::size_t end_of_base(std::string_view text) {
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    depth += (c == '<' || c == '(') - (c == '>' || c == ')');
    if (depth <= 0 && (c == '.' || c == '[')) return i;
  }
  return text.size();
}

// "main.c:state": the file's part; npos: there is none.
std::size_t file_colon(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != ':') continue;
    if (i + 1 < text.size() && text[i + 1] == ':') {
      ++i;
      continue;
    }
    return i;
  }
  return std::string_view::npos;
}

template <class T>
bool whole_number(std::string_view text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

}  // namespace

VariableNames::VariableNames(std::shared_ptr<const DebugInfo> info, VariableSpace space)
    : info_(std::move(info)), space_(space) {}

std::optional<int> VariableNames::state_type() const {
  if (space_.state_bytes == 0) return std::nullopt;
  const std::vector<int> types = info_->structs_of(space_.state_bytes);
  return types.size() == 1 ? std::optional(types.front()) : std::nullopt;
}

std::string VariableNames::unknown(std::string_view name) const {
  if (const auto local = info_->locals().find(name); local != info_->locals().end()) {
    return fmt::format(
        "is a local of {}(): it has no place of its own (make it static, or keep it in a struct)",
        local->second.function);
  }
  std::vector<std::string_view> names;
  for (const DebugVariable& v : info_->variables()) names.push_back(v.name);
  if (names.empty()) return "is not there: the file has no variables with debug information";
  const std::string_view near = nearest_spelling(name, names);
  return near.empty() ? "is no variable of it; omnihil variables FILE lists them"
                      : fmt::format("is no variable of it; did you mean \"{}\"?", near);
}

// The library's state block, as the struct that has its size.
std::optional<VariablePlace> VariableNames::state_block(std::string& problem) const {
  VariablePlace place;
  place.piece = {MemorySpace::kState, 0, 0, space_.state_bytes};
  place.writable = true;
  const std::vector<int> types = info_->structs_of(space_.state_bytes);
  if (types.size() == 1) {
    place.type = types.front();
    return place;
  }
  std::vector<std::string> names;
  for (const int t : types) names.push_back(info_->type(t).name);
  problem = types.empty()
                ? fmt::format("no struct has the state block's {} bytes; say which it is: state(NAME)",
                              space_.state_bytes)
                : fmt::format("several structs have the state block's {} bytes ({}); say which: state(NAME)",
                              space_.state_bytes, fmt::join(names, ", "));
  return std::nullopt;
}

// "state(reference_state)": bytes that the program itself takes for that struct.
bool VariableNames::read_as(std::string_view wanted, VariablePlace& place, std::string& problem) const {
  const std::optional<int> type = info_->struct_named(wanted);
  if (!type) {
    problem = fmt::format("no struct is called {}", wanted);
  } else if (info_->type(*type).bytes > place.piece.bytes) {
    problem = fmt::format("{} has {} bytes, what is to be read as it {}", wanted, info_->type(*type).bytes,
                          place.piece.bytes);
  } else {
    place.type = *type;
    place.piece.bytes = info_->type(*type).bytes;
    if (!place.constant.empty()) place.constant.resize(place.piece.bytes);
    return true;
  }
  return false;
}

std::optional<VariablePlace> VariableNames::base(std::string_view name, std::string& problem) const {
  std::string_view file;
  if (const std::size_t colon = file_colon(name); colon != std::string_view::npos) {
    file = name.substr(0, colon);
    name = name.substr(colon + 1);
  }
  std::vector<const DebugVariable*> found;
  const auto& all = info_->variables();
  for (auto v = std::ranges::lower_bound(all, name, {},
                                         [](const DebugVariable& x) { return std::string_view(x.name); });
       v != all.end() && v->name == name; ++v) {
    if (file.empty() || v->file == file) found.push_back(&*v);
  }
  if (found.empty() && name == "state" && space_.state_bytes > 0) return state_block(problem);
  if (found.empty()) {
    problem = file.empty() ? unknown(name) : fmt::format("is no variable of a file {}", file);
    return std::nullopt;
  }
  if (found.size() > 1 && found[1]->why_not.empty()) {
    std::vector<std::string> names;
    for (const DebugVariable* v : found) names.push_back(v->file + ":" + v->name);
    problem = fmt::format("is there {} times; say which: {}", found.size(), fmt::join(names, ", "));
    return std::nullopt;
  }
  const DebugVariable& v = *found.front();
  if (!v.why_not.empty()) {
    problem = v.why_not;
    return std::nullopt;
  }
  VariablePlace place;
  place.piece = {MemorySpace::kImage, 0, v.address.value_or(0), info_->type(v.type).bytes};
  place.type = v.type;
  place.constant = v.constant;
  place.writable = v.writable;
  return place;
}

bool VariableNames::into_member(std::string_view member, VariablePlace& place) const {
  const DebugType& type = info_->type(place.type);
  const auto enter = [&](const DebugMember& m, VariablePlace from) {
    from.piece.address += m.offset_bytes;
    from.type = m.type;
    from.bits = m.bits;
    from.bit_offset = m.bit_offset;
    from.piece.bytes = m.bits > 0 ? (m.bit_offset + m.bits + 7) / 8 : info_->type(m.type).bytes;
    if (!from.constant.empty()) {
      const auto begin = from.constant.begin() + static_cast<std::ptrdiff_t>(m.offset_bytes);
      from.constant = {begin, begin + static_cast<std::ptrdiff_t>(from.piece.bytes)};
    }
    return from;
  };
  for (const DebugMember& m : type.members) {
    if (m.name != member) continue;
    place = enter(m, place);
    return true;
  }
  for (const DebugMember& m : type.members) {  // of a base class or a struct without a name
    if (!m.name.empty() || m.type == place.type) continue;
    if (info_->type(m.type).form != DebugType::Form::kStruct || info_->type(m.type).bytes > type.bytes)
      continue;
    VariablePlace inner = enter(m, place);
    if (!into_member(member, inner)) continue;
    place = inner;
    return true;
  }
  return false;
}

// Those of base classes and structs without a name among them.
std::vector<std::string> VariableNames::member_names(int type, int depth) const {
  constexpr int kDeepest = 16;
  std::vector<std::string> names;
  for (const DebugMember& m : info_->type(type).members) {
    if (!m.name.empty()) {
      names.push_back("." + m.name);
    } else if (depth < kDeepest && info_->type(m.type).form == DebugType::Form::kStruct) {
      for (std::string& inner : member_names(m.type, depth + 1)) names.push_back(std::move(inner));
    }
  }
  return names;
}

// Those next to `wanted` first.
std::string VariableNames::members_text(int type, std::string_view wanted) const {
  std::vector<std::string> names = member_names(type, 0);
  const std::vector<std::string_view> views(names.begin(), names.end());
  const std::string near(wanted.empty() ? "" : nearest_spelling("." + std::string(wanted), views));
  if (const auto at = std::ranges::find(names, near); at != names.end())
    std::rotate(names.begin(), at, at + 1);
  const bool more = names.size() > kMostNamed;
  if (more) names.resize(kMostNamed);
  return fmt::format("{}{}", fmt::join(names, ", "), more ? ", …" : "");
}

// One "[2]" or ".member" of `rest`.
bool VariableNames::step(std::string_view& rest, VariablePlace& place, std::string& problem) const {
  const DebugType& type = info_->type(place.type);
  if (rest.front() == '[') {
    const std::size_t close = rest.find(']');
    std::uint64_t index = 0;
    if (close == std::string_view::npos || !whole_number(rest.substr(1, close - 1), index)) {
      problem = fmt::format("\"{}\" is no index", rest);
    } else if (type.form != DebugType::Form::kArray) {
      problem = fmt::format("is a {} and no array", type.name);
    } else if (index >= type.count) {
      problem = type.count == 0
                    ? fmt::format("is a {} without elements", type.name)
                    : fmt::format("has {} elements; allowed: [0] to [{}]", type.count, type.count - 1);
    } else {
      const std::uint64_t bytes = info_->type(type.element).bytes;
      place.piece.address += index * bytes;
      place.piece.bytes = bytes;
      if (!place.constant.empty()) {
        const auto begin = place.constant.begin() + static_cast<std::ptrdiff_t>(index * bytes);
        place.constant = std::vector<std::uint8_t>(begin, begin + static_cast<std::ptrdiff_t>(bytes));
      }
      place.type = type.element;
      rest.remove_prefix(close + 1);
      return true;
    }
    return false;
  }
  if (rest.front() != '.') {
    problem = fmt::format("\"{}\" is neither [index] nor .member", rest);
    return false;
  }
  const std::size_t end = std::min(rest.find_first_of(".[", 1), rest.size());
  const std::string_view member = rest.substr(1, end - 1);
  if (type.form != DebugType::Form::kStruct) {
    problem = fmt::format("is a {}, which has no member {}", type.name, member);
    return false;
  }
  if (!into_member(member, place)) {
    problem =
        fmt::format("{} has no member {}; it has {}", type.name, member, members_text(place.type, member));
    return false;
  }
  rest.remove_prefix(end);
  return true;
}

std::optional<VariablePlace> VariableNames::find(std::string_view name, std::string& problem) const {
  const std::string whole(name);
  std::uint32_t board = 0;
  if (const std::size_t at = name.rfind('@'); at != std::string_view::npos) {
    if (!whole_number(name.substr(at + 1), board) || board >= space_.boards) {
      problem = fmt::format("\"{}\" is no board; allowed: @0 to @{}", name.substr(at), space_.boards - 1);
      return std::nullopt;
    }
    name = name.substr(0, at);
  }
  // A file's name has dots itself: the variable begins behind it.
  const std::size_t colon = file_colon(name);
  const std::size_t from = colon == std::string_view::npos ? 0 : colon + 1;
  const std::size_t end = from + end_of_base(name.substr(from));
  std::string_view variable = name.substr(0, end), as;
  if (const std::size_t open = variable.find('('); open != std::string_view::npos && variable.back() == ')') {
    as = variable.substr(open + 1, variable.size() - open - 2);
    variable = variable.substr(0, open);
  }
  auto place = base(variable, problem);
  if (!as.empty() && !place && variable == "state" && space_.state_bytes > 0) {  // of whatever struct
    place = VariablePlace{};
    place->piece = {MemorySpace::kState, 0, 0, space_.state_bytes};
    place->writable = true;
  }
  if (!place || (!as.empty() && !read_as(as, *place, problem))) return std::nullopt;
  problem.clear();
  std::string_view rest = name.substr(end);
  while (!rest.empty()) {
    if (!step(rest, *place, problem)) return std::nullopt;
  }
  place->name = whole;
  place->piece.board = board;
  return place;
}

std::optional<VariablePlace> VariableNames::find_value(std::string_view name, std::string& problem) const {
  auto place = find(name, problem);
  if (!place) return std::nullopt;
  const DebugType& type = info_->type(place->type);
  if (type.form == DebugType::Form::kScalar) return place;
  problem = fmt::format("is a {}, no single value", type.name);
  if (type.form == DebugType::Form::kStruct) problem += "; it has " + members_text(place->type);
  if (type.form == DebugType::Form::kArray && type.count > 0)
    problem += fmt::format("; it has [0] to [{}]", type.count - 1);
  return std::nullopt;
}

std::vector<VariablePlace> VariableNames::values_of(const VariablePlace& place, std::size_t most) const {
  std::vector<VariablePlace> values, todo{place};
  while (!todo.empty() && values.size() < most) {
    const VariablePlace next = todo.back();
    todo.pop_back();
    const DebugType& type = info_->type(next.type);
    std::vector<VariablePlace> parts;
    const auto add = [&](const std::string& step_text) {
      VariablePlace part = next;
      std::string_view rest = step_text;
      std::string problem;
      if (!step(rest, part, problem)) return;
      const std::size_t at = next.name.rfind('@');
      part.name = at == std::string::npos ? next.name + step_text
                                          : next.name.substr(0, at) + step_text + next.name.substr(at);
      parts.push_back(std::move(part));
    };
    if (type.form == DebugType::Form::kScalar) {
      values.push_back(next);
    } else if (type.form == DebugType::Form::kArray) {
      for (std::uint64_t i = 0; i < std::min<std::uint64_t>(type.count, most); ++i)
        add(fmt::format("[{}]", i));
    } else if (type.form == DebugType::Form::kStruct && next.name.size() < 1000) {
      for (const std::string& member : member_names(next.type, 0)) add(member);
    }
    todo.insert(todo.end(), parts.rbegin(), parts.rend());
  }
  return values;
}

std::uint64_t state_bytes_of(const DebugInfo& info) {
  for (const DebugVariable& v : info.variables()) {
    if (v.type < 0 || !v.address || info.type(v.type).name.find("omnihil_firmware_api") == std::string::npos)
      continue;
    for (const DebugMember& m : info.type(v.type).members) {
      if (m.name != "state_bytes" || info.type(m.type).bytes > 8) continue;
      std::uint64_t value = 0;
      const auto raw = info.initial(*v.address + m.offset_bytes, info.type(m.type).bytes);
      std::copy(raw.begin(), raw.end(), reinterpret_cast<std::uint8_t*>(&value));
      return value;
    }
  }
  return 0;
}

}  // namespace omnihil
