#include "protocols/field_table.h"

#include <cstdio>
#include <cstdlib>

namespace omnihil {
namespace {

// A field name that the table does not have is a mistake of ours, never of the input.
std::size_t existing_index(const Message* message, std::string_view field) {
  const int index = message == nullptr ? -1 : message->field_index(field);
  if (index < 0) {
    std::fprintf(stderr, "packet '%.*s' has no field '%.*s'\n",
                 message == nullptr ? 0 : static_cast<int>(message->name.size()),
                 message == nullptr ? "" : message->name.data(), static_cast<int>(field.size()),
                 field.data());
    std::abort();
  }
  return static_cast<std::size_t>(index);
}

}  // namespace

int Message::field_index(std::string_view field) const {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (fields[i].name == field) return static_cast<int>(i);
  }
  return -1;
}

int Message::field_index(FieldRole wanted) const {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (fields[i].role == wanted) return static_cast<int>(i);
  }
  return -1;
}

const Message* message_of_type(std::span<const Message> messages, std::uint32_t type) {
  for (const Message& message : messages) {
    if (message.type == type) return &message;
  }
  return nullptr;
}

const Message* message_of_role(std::span<const Message> messages, MessageRole role) {
  for (const Message& message : messages) {
    if (message.role == role) return &message;
  }
  return nullptr;
}

double Values::number(std::string_view field) const { return fields[existing_index(message, field)].number; }

void Values::set(std::string_view field, double number) {
  fields[existing_index(message, field)] = {.number = number, .raw = 0};
}

}  // namespace omnihil
