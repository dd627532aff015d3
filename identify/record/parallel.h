// Work that does not depend on its order, on several threads. Each piece writes to its own place, so the
// result is the same at any number of threads.
//
//   const ThreadTeam team(jobs);                                // while it lives, of all loops of this thread
//   parallel_for(jobs, n, [&](int k) { out[k] = work(k); });
//
// A loop that begins while there is a team, or within a piece of another loop, asks for no `jobs`: its pieces
// go to threads of the team that have nothing else to do, those of the outermost loop first. Who waits for
// the end of a loop takes pieces of loops within that one alone: what it waits for is never behind something
// longer (leapfrogging: Wagner, Calder 1993). An exception of a piece is thrown again here, after all pieces
// have ended: that of the lowest index k. No piece may wait for another.
#pragma once
#include <functional>
#include <memory>

namespace omnihil {

// `threads`: with the one that makes it. Within another team, and of one thread, it is none.
class ThreadTeam {
 public:
  explicit ThreadTeam(int threads);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  class Shared;

 private:
  std::unique_ptr<Shared> shared_;  // null: none
};

// By the team that is there, else by `jobs` threads.
void run_pieces(int jobs, int count, const std::function<void(int)>& work);

template <typename Work>
void parallel_for(int jobs, int count, Work&& work) {
  run_pieces(jobs, count, std::ref(work));
}

// By the team that is there, else one after another.
template <typename Work>
void parallel_for(int count, Work&& work) {
  run_pieces(1, count, std::ref(work));
}

}  // namespace omnihil
