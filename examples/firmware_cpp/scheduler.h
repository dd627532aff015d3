// A cooperative scheduler as many robots have one: a timer interrupt counts, tasks run when their turn has
// come.
//
//   Scheduler<Robot, 3> scheduler({{{500, &Robot::wheel_task}, {2000, &Robot::motion_task}, …}});
//   scheduler.run(robot, now_us);         // from the main loop, or from the bench's tick()
//
// Tasks run in the order of the table. A task that was due several times since the last call runs once and
// the turns it lost are counted: that is what an over-run looks like on the board.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

namespace example {

template <class Robot, std::size_t kTasks>
class Scheduler {
 public:
  struct Task {
    std::uint32_t period_us;
    void (Robot::*run)(float dt_s);
  };

  explicit Scheduler(const std::array<Task, kTasks>& tasks) : tasks_(tasks) {}

  void run(Robot& robot, std::uint64_t now_us) {
    for (std::size_t n = 0; n < kTasks; ++n) {
      const Task& task = tasks_[n];
      if (started_ && now_us < due_us_[n]) continue;
      if (!started_) due_us_[n] = now_us;
      const std::uint64_t late = (now_us - due_us_[n]) / task.period_us;
      lost_turns_ += static_cast<std::uint32_t>(late);
      due_us_[n] += (late + 1) * task.period_us;
      (robot.*task.run)(1e-6f * static_cast<float>((late + 1) * task.period_us));
    }
    started_ = true;
  }

  std::uint32_t lost_turns() const { return lost_turns_; }

 private:
  std::array<Task, kTasks> tasks_;
  std::array<std::uint64_t, kTasks> due_us_{};
  std::uint32_t lost_turns_ = 0;
  bool started_ = false;
};

}  // namespace example
