// The league's synchronous protocol: a client asks for a step, gets the state after it, and nothing moves in between.
//
//   LeagueSync sync;
//   std::string error;
//   if (!sync.listen("127.0.0.1", 10304, error)) std::cerr << error;
//   while (sync.serve_one(session, host, step, 100)) {}       // one request; false: none came within 100 ms
//
// SimulationSyncRequest and SimulationSyncResponse over TCP, each behind its length as a varint (as the league's game
// controller does in its CI mode; the published messages name no carrier). One client at a time. A step is a whole
// number of loop steps; another one is an error in the answer and nothing moves.
#pragma once
#include <functional>
#include <string>

#include "hil/league/league_host.h"
#include "hil/wire/descriptor.h"

namespace omnihil {

class LeagueSync {
 public:
  bool listen(const std::string& address, int port, std::string& error);
  int port() const;

  // Waits up to `timeout_ms` for a client and its next request, does it, answers. `step` is one loop step.
  // False: nothing came.
  bool serve_one(Session& session, LeagueHost& host, const std::function<void()>& step, int timeout_ms);
  bool has_client() const { return client_.get() >= 0; }

 private:
  bool take_client(int timeout_ms);
  bool take_request(int timeout_ms);
  void answer(const std::string& bytes);

  Descriptor listener_, client_;
  std::string waiting_;  // bytes of the client that are no whole request yet
  std::string request_;
};

// A length as protobuf writes it, in front of `bytes`.
std::string behind_length(const std::string& bytes);
// The first whole message of `waiting`, taken out of it; false: not there yet. `bad`: no length, or more than 1 MiB.
bool take_behind_length(std::string& waiting, std::string& message, bool& bad);

}  // namespace omnihil
