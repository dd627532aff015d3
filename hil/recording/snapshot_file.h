// A moment of a bench as a file: robots, motors, batteries, ball; to begin from (`serve --from`).
//
//   write_snapshot("corner.snapshot", {.at_ns = 3'200'000'000, .commit = "1a2b3c4", .robots = "6 of ulaval_2024",
//                                      .world = session.world().save()});
//   Snapshot again = load_snapshot("corner.snapshot", problems);
//   config.from = again.world;                       // the same robots, physics and steps, or Session refuses it
//
// Two lines of text: JSON with format "omnihil-snapshot/1", commit, robots and at_ns, and hex digits. The bytes are this
// program's own: another version may refuse them. Cannot: what radio and firmware remember.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace omnihil {

struct Snapshot {
  std::int64_t at_ns = 0;
  std::string commit, robots;  // who made it, of what: for people
  std::vector<std::uint8_t> world;
};

// Throws std::system_error; nothing half-written.
void write_snapshot(const std::string& file, const Snapshot& snapshot);

// What is wrong goes to `problems`, a line each; the world is then empty.
Snapshot load_snapshot(const std::string& file, std::vector<std::string>& problems);

}  // namespace omnihil
