#include "hil/variables/debug_types.h"

#include <dwarf.h>
#include <fmt/format.h>

#include <algorithm>

namespace omnihil {
namespace {

constexpr int kDeepest = 64;                        // of what names what; deeper is a broken file
constexpr std::uint64_t kLargest = 1u << 28;        // bytes of one variable; larger is one, too
constexpr std::size_t kMostEnumerators = 1u << 16;  // likewise

bool is_qualifier(int tag) {
  return tag == DW_TAG_typedef || tag == DW_TAG_const_type || tag == DW_TAG_volatile_type ||
         tag == DW_TAG_restrict_type || tag == DW_TAG_atomic_type;
}

std::string type_words(Dwarf_Die die, int depth = 0) {
  if (depth > kDeepest) return "?";
  const std::string name = name_of(&die);
  const int tag = dwarf_tag(&die);
  if (tag == DW_TAG_pointer_type || tag == DW_TAG_reference_type || tag == DW_TAG_rvalue_reference_type) {
    Dwarf_Die target;
    return (type_die_of(&die, &target) ? type_words(target, depth + 1) : "void") +
           (tag == DW_TAG_pointer_type ? "*" : "&");
  }
  if (is_qualifier(tag) && (tag != DW_TAG_typedef || name.empty())) {
    Dwarf_Die target;
    return type_die_of(&die, &target) ? type_words(target, depth + 1) : "void";
  }
  const char* kind = tag == DW_TAG_structure_type     ? "struct"
                     : tag == DW_TAG_union_type       ? "union"
                     : tag == DW_TAG_enumeration_type ? "enum"
                                                      : "";
  if (name.empty()) return *kind != 0 ? kind : "?";
  return *kind != 0 ? fmt::format("{} {}", kind, name) : name;
}

// A number, or in DWARF 2 an expression that adds one to the struct's address.
std::optional<std::uint64_t> member_location(Dwarf_Die* die) {
  Dwarf_Attribute found;
  if (dwarf_attr_integrate(die, DW_AT_data_member_location, &found) == nullptr) return 0;
  Dwarf_Op* ops = nullptr;
  std::size_t count = 0;
  if (dwarf_whatform(&found) != DW_FORM_block1 || dwarf_getlocation(&found, &ops, &count) != 0)
    return number_of(die, DW_AT_data_member_location);
  return count == 1 && ops[0].atom == DW_OP_plus_uconst ? std::optional(ops[0].number) : std::nullopt;
}

}  // namespace

std::optional<std::uint64_t> number_of(Dwarf_Die* die, unsigned attribute) {
  Dwarf_Attribute found;
  if (dwarf_attr_integrate(die, attribute, &found) == nullptr) return std::nullopt;
  const unsigned form = dwarf_whatform(&found);
  if (form == DW_FORM_sdata || form == DW_FORM_implicit_const) {
    Dwarf_Sword value = 0;
    if (dwarf_formsdata(&found, &value) != 0) return std::nullopt;
    return static_cast<std::uint64_t>(value);
  }
  Dwarf_Word value = 0;
  if (dwarf_formudata(&found, &value) != 0) return std::nullopt;
  return value;
}

std::string name_of(Dwarf_Die* die) {
  Dwarf_Attribute found;
  if (dwarf_attr_integrate(die, DW_AT_name, &found) == nullptr) return {};
  const char* text = dwarf_formstring(&found);
  return text != nullptr ? text : "";
}

bool type_die_of(Dwarf_Die* die, Dwarf_Die* out) {
  Dwarf_Attribute found;
  return dwarf_attr_integrate(die, DW_AT_type, &found) != nullptr &&
         dwarf_formref_die(&found, out) != nullptr;
}

int DebugTypes::of(Dwarf_Die* die) {
  Dwarf_Die target;
  return type_die_of(die, &target) ? made_from(target) : -1;
}

// Typedefs and qualifiers lead on; the name is the outermost typedef's.
int DebugTypes::made_from(Dwarf_Die die) {
  const void* const first = die.addr;
  if (const auto found = known_.find(first); found != known_.end()) return found->second;
  std::string name;
  for (int steps = 0; is_qualifier(dwarf_tag(&die)); ++steps) {
    if (name.empty() && dwarf_tag(&die) == DW_TAG_typedef) name = name_of(&die);
    Dwarf_Die target;
    if (steps > kDeepest || !type_die_of(&die, &target)) return -1;
    die = target;
  }
  const int index = of_peeled(die);
  if (index < 0 || name.empty() || types_[static_cast<std::size_t>(index)].name == name) return index;
  DebugType renamed = types_[static_cast<std::size_t>(index)];
  if (renamed.form == DebugType::Form::kStruct && renamed.members.empty()) return index;  // not complete yet
  renamed.name = name;
  types_.push_back(std::move(renamed));
  return known_[first] = static_cast<int>(types_.size()) - 1;
}

int DebugTypes::of_peeled(Dwarf_Die die) {
  Dwarf_Attribute signature;  // what stands here is in a unit of its own
  Dwarf_Die whole;
  if (dwarf_attr(&die, DW_AT_signature, &signature) != nullptr &&
      dwarf_formref_die(&signature, &whole) != nullptr)
    die = whole;
  const void* const place = die.addr;
  if (const auto found = known_.find(place); found != known_.end()) return found->second;
  if (depth_ > kDeepest) return -1;
  ++depth_;
  const int tag = dwarf_tag(&die);
  int index = -1;
  if (tag == DW_TAG_array_type) {
    index = array(&die);
  } else {
    index = static_cast<int>(types_.size());
    known_[place] = index;  // a struct that holds itself finds itself
    types_.emplace_back();
    DebugType made;
    if (tag == DW_TAG_structure_type || tag == DW_TAG_union_type || tag == DW_TAG_class_type) {
      made = structure(&die);
    } else if (tag == DW_TAG_enumeration_type) {
      made = enumeration(&die);
    } else {
      made = scalar(&die);
    }
    made.name = type_words(die);
    types_[static_cast<std::size_t>(index)] = std::move(made);
  }
  --depth_;
  return known_[place] = index;
}

DebugType DebugTypes::scalar(Dwarf_Die* die) const {
  DebugType type;
  const int tag = dwarf_tag(die);
  type.bytes = number_of(die, DW_AT_byte_size).value_or(0);
  if (tag == DW_TAG_pointer_type || tag == DW_TAG_reference_type || tag == DW_TAG_rvalue_reference_type) {
    Dwarf_Half address_bytes = 4;
    Dwarf_Die unit;
    std::uint8_t size = 0;
    if (type.bytes == 0 && dwarf_diecu(die, &unit, &size, nullptr) != nullptr) address_bytes = size;
    if (type.bytes == 0) type.bytes = address_bytes;
    type.form = DebugType::Form::kScalar;
    type.kind = ValueKind::kPointer;
    return type;
  }
  if (tag != DW_TAG_base_type) return type;
  switch (number_of(die, DW_AT_encoding).value_or(0)) {
    case DW_ATE_boolean:
      type.kind = ValueKind::kBool;
      break;
    case DW_ATE_float:
      type.kind = ValueKind::kReal;
      break;
    case DW_ATE_signed:
    case DW_ATE_signed_char:
      type.kind = ValueKind::kSigned;
      break;
    case DW_ATE_unsigned:
    case DW_ATE_unsigned_char:
    case DW_ATE_UTF:
      type.kind = ValueKind::kUnsigned;
      break;
    default:
      return type;  // complex, decimal: not read
  }
  const bool real = type.kind == ValueKind::kReal;
  const bool size = real ? type.bytes == 4 || type.bytes == 8 : type.bytes >= 1 && type.bytes <= 8;
  if (size) type.form = DebugType::Form::kScalar;
  return type;
}

DebugType DebugTypes::enumeration(Dwarf_Die* die) const {
  DebugType type;
  type.bytes = number_of(die, DW_AT_byte_size).value_or(0);
  if (type.bytes >= 1 && type.bytes <= 8) type.form = DebugType::Form::kScalar;
  type.kind = ValueKind::kEnumeration;
  Dwarf_Die child;
  if (dwarf_child(die, &child) != 0) return type;
  do {
    if (dwarf_tag(&child) != DW_TAG_enumerator) continue;
    const auto value = static_cast<std::int64_t>(number_of(&child, DW_AT_const_value).value_or(0));
    type.negative = type.negative || value < 0;
    if (std::string name = name_of(&child); !name.empty())
      type.enumerators.emplace_back(std::move(name), value);
  } while (type.enumerators.size() < kMostEnumerators && dwarf_siblingof(&child, &child) == 0);
  return type;
}

DebugType DebugTypes::structure(Dwarf_Die* die) {
  DebugType type;
  type.form = DebugType::Form::kStruct;
  type.bytes = number_of(die, DW_AT_byte_size).value_or(0);
  Dwarf_Die child;
  if (dwarf_child(die, &child) != 0) return type;
  do {
    const int tag = dwarf_tag(&child);
    if (tag == DW_TAG_member || tag == DW_TAG_inheritance) add_member(&child, type);
  } while (dwarf_siblingof(&child, &child) == 0);
  return type;
}

// DWARF 5, section 5.7.6: a bit-field says data_bit_offset, from the struct's begin; before version 4 bit_offset, from
// the highest bit of its storage unit.
void DebugTypes::add_member(Dwarf_Die* child, DebugType& type) {
  DebugMember member;
  if (dwarf_tag(child) == DW_TAG_member) member.name = name_of(child);
  if (number_of(child, DW_AT_declaration) || number_of(child, DW_AT_external)) return;  // static: not inside
  member.type = of(child);
  if (member.type < 0) return;
  const auto location = member_location(child);
  if (!location) return;  // a virtual base: the object itself says where
  member.offset_bytes = *location;
  const std::uint64_t bits = number_of(child, DW_AT_bit_size).value_or(0);
  const std::uint64_t member_bytes = types_[static_cast<std::size_t>(member.type)].bytes;
  if (bits > 0 && bits <= 64) {
    std::uint64_t at = member.offset_bytes * 8;
    if (const auto from_begin = number_of(child, DW_AT_data_bit_offset)) {
      at = *from_begin;
    } else if (const auto from_top = number_of(child, DW_AT_bit_offset)) {
      const std::uint64_t unit = number_of(child, DW_AT_byte_size).value_or(member_bytes) * 8;
      if (*from_top + bits > unit) return;
      at += unit - *from_top - bits;
    }
    member.offset_bytes = at / 8;
    member.bit_offset = static_cast<unsigned>(at % 8);
    member.bits = static_cast<unsigned>(bits);
  }
  const std::uint64_t needs = member.bits > 0 ? (member.bit_offset + member.bits + 7) / 8 : member_bytes;
  if (member.offset_bytes > kLargest || needs > kLargest || member.offset_bytes + needs > type.bytes) return;
  type.members.push_back(std::move(member));
}

// The first subrange is the outermost.
int DebugTypes::array(Dwarf_Die* die) {
  std::vector<std::uint64_t> counts;
  Dwarf_Die child;
  for (int more = dwarf_child(die, &child); more == 0; more = dwarf_siblingof(&child, &child)) {
    if (dwarf_tag(&child) != DW_TAG_subrange_type || counts.size() > 8) continue;
    const auto last = number_of(&child, DW_AT_upper_bound);
    const auto count = number_of(&child, DW_AT_count);
    counts.push_back(count ? *count : last ? *last + 1 : 0);
  }
  int element = of(die);
  if (element < 0) return -1;
  for (std::size_t i = counts.size(); i-- > 0;) {
    const DebugType& inner = types_[static_cast<std::size_t>(element)];
    DebugType type;
    if (inner.bytes > 0 && counts[i] <= kLargest / inner.bytes) {
      type.form = DebugType::Form::kArray;
      type.count = counts[i];
      type.bytes = counts[i] * inner.bytes;
    }
    type.element = element;
    const std::size_t bracket = std::min(inner.name.find('['), inner.name.size());
    type.name = fmt::format("{}[{}]{}", inner.name.substr(0, bracket), counts[i], inner.name.substr(bracket));
    types_.push_back(std::move(type));
    element = static_cast<int>(types_.size()) - 1;
  }
  return element;
}

}  // namespace omnihil
