// Reading a message of the league, and which fields of it were set and are not done here: each gives one error, by its path.
//
//   if (!read_message(datagram, command, errors)) return;       // UNREADABLE, with the required fields that are missing
//   refuse_unsupported(command, {"id", "move_command", "kick_speed"}, "robot 3: ", errors);
#pragma once
#include <google/protobuf/message.h>

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "hil/league/league_robots.h"

namespace omnihil {

bool read_message(std::string_view bytes, google::protobuf::Message& message,
                  std::vector<LeagueError>& errors);

// `supported`: names of fields of this message that are taken; everything in them counts as taken. Unknown fields, of a
// newer protocol, are errors too.
void refuse_unsupported(const google::protobuf::Message& message,
                        std::initializer_list<std::string_view> supported, const std::string& place,
                        std::vector<LeagueError>& errors);

}  // namespace omnihil
