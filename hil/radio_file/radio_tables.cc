#include "hil/radio_file/radio_tables.h"

#include <algorithm>

#include "protocols/scale_rules.h"

namespace omnihil {
namespace {

bool same(const ChecksumRule* a, const ChecksumRule* b) {
  if (a == nullptr || b == nullptr) return a == b;
  return a->kind == b->kind && a->from == b->from && a->until == b->until;
}

bool same(const Field& a, const Field& b) {
  return a.name == b.name && a.bit == b.bit && a.bits == b.bits && a.kind == b.kind && a.sign == b.sign &&
         a.lo == b.lo && a.hi == b.hi && a.constant == b.constant && a.cause == b.cause &&
         a.scale == b.scale && same(a.check, b.check) && a.unit == b.unit && a.envelope == b.envelope &&
         a.role == b.role && a.only_if == b.only_if && a.tag == b.tag && a.names == b.names;
}

bool same_head(const Message& a, const Message& b) {
  return a.name == b.name && a.type == b.type && a.size_bytes == b.size_bytes && a.direction == b.direction &&
         a.bit_order == b.bit_order && a.text_tail == b.text_tail && a.role == b.role &&
         a.answer_type == b.answer_type;
}

bool same_list(const RadioFormat& a, const RadioFormat& b) {
  if (a.list == nullptr || b.list == nullptr) return a.list == b.list;
  return std::ranges::equal(a.list->begin, b.list->begin) && a.list->end == b.list->end &&
         a.list->most == b.list->most;
}

}  // namespace

const ChecksumRule* RadioTables::keep(const ChecksumRule& sum) {
  for (const ChecksumRule& known : sums) {
    if (same(&known, &sum)) return &known;
  }
  return &sums.emplace_back(sum);
}

std::string first_difference(const RadioFormat& a, const RadioFormat& b) {
  if (a.framing != b.framing || !same_list(a, b)) return "the framing";
  for (std::size_t m = 0; m < std::min(a.messages.size(), b.messages.size()); ++m) {
    const Message& ours = a.messages[m];
    const Message& theirs = b.messages[m];
    const std::string packet = "packet " + std::string(ours.name);
    if (!same_head(ours, theirs)) return packet;
    if (ours.fields.size() != theirs.fields.size()) return packet + ", the number of its fields";
    for (std::size_t i = 0; i < ours.fields.size(); ++i) {
      if (!same(ours.fields[i], theirs.fields[i]))
        return packet + ", field " + std::string(ours.fields[i].name);
    }
  }
  return a.messages.size() == b.messages.size() ? "" : "the number of packets";
}

}  // namespace omnihil
