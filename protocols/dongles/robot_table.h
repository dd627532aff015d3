// The robots behind a dongle, by their ids.
//
//   struct Robot { int id = 0; … };
//   RobotTable<Robot, 16> robots(config.robot_ids);
//   if (Robot* robot = robots.find(id)) …                 // nullptr: there is no such robot
//   for (Robot& robot : robots) …                         // every robot there is, by id
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace omnihil {

// Ids are 0 to kIds - 1; others in the list are the caller's mistake (std::out_of_range).
template <class T, std::size_t kIds>
class RobotTable {
 public:
  explicit RobotTable(std::span<const int> ids) : robots_(ids.size()) {
    place_.fill(-1);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      place_.at(static_cast<std::size_t>(ids[i])) = static_cast<int>(i);
    }
  }
  T* find(int id) {
    const bool valid = id >= 0 && id < static_cast<int>(kIds);
    const int place = valid ? place_[static_cast<std::size_t>(id)] : -1;
    return place < 0 ? nullptr : &robots_[static_cast<std::size_t>(place)];
  }
  auto begin() { return robots_.begin(); }
  auto end() { return robots_.end(); }
  auto begin() const { return robots_.begin(); }
  auto end() const { return robots_.end(); }

 private:
  std::array<int, kIds> place_{};
  std::vector<T> robots_;
};

}  // namespace omnihil
