#include "hil/league/league_fields.h"

#include <google/protobuf/unknown_field_set.h>

#include <algorithm>

namespace omnihil {

bool read_message(std::string_view bytes, google::protobuf::Message& message,
                  std::vector<LeagueError>& errors) {
  // Partial, since the whole way writes to stderr for every message that a client gets wrong.
  if (!message.ParsePartialFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
    errors.push_back(
        {"UNREADABLE", std::to_string(bytes.size()) + " bytes are no " + message.GetDescriptor()->name()});
    return false;
  }
  if (message.IsInitialized()) return true;
  errors.push_back(
      {"UNREADABLE", message.GetDescriptor()->name() + " lacks " + message.InitializationErrorString()});
  return false;
}

void refuse_unsupported(const google::protobuf::Message& message,
                        std::initializer_list<std::string_view> supported, const std::string& place,
                        std::vector<LeagueError>& errors) {
  const google::protobuf::Reflection& reflection = *message.GetReflection();
  std::vector<const google::protobuf::FieldDescriptor*> set;
  reflection.ListFields(message, &set);
  for (const google::protobuf::FieldDescriptor* field : set) {
    if (std::find(supported.begin(), supported.end(), field->name()) != supported.end()) continue;
    errors.push_back({"UNSUPPORTED_FIELD",
                      place + message.GetDescriptor()->name() + "." + field->name() + " is not done"});
  }
  const google::protobuf::UnknownFieldSet& unknown = reflection.GetUnknownFields(message);
  for (int i = 0; i < unknown.field_count(); ++i) {
    errors.push_back({"UNSUPPORTED_FIELD", place + message.GetDescriptor()->name() + ": field number " +
                                               std::to_string(unknown.field(i).number()) + " is not known"});
  }
}

}  // namespace omnihil
