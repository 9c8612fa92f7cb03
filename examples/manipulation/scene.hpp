// The three scenes: a table, coloured blocks, their goals, a gripper that hangs from above.
// Takes: a task. Gives: its model in MuJoCo's XML. Keeps true: all scenes have the same table,
// gripper and camera; lengths are metres, z points up and is 0 on the table.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

namespace manipulation {

enum class Task { sorting, stacking, pick_place };
inline const std::map<std::string, Task> kTasks{
    {"sorting", Task::sorting}, {"stacking", Task::stacking}, {"pick_place", Task::pick_place}};

using Place = std::array<double, 2>;  ///< x, y on the table
using Color = std::array<double, 3>;  ///< red, green, blue; 0 to 1

inline constexpr double kBlock = 0.05;  ///< edge of a block
inline constexpr double kZone = 0.07;   ///< half the edge of a zone
inline constexpr double kWall = 0.09;   ///< height of the wall of pick_place
inline constexpr Place kRedZone{-0.15, 0.12};
inline constexpr Place kBlueZone{0.15, 0.12};
inline constexpr Place kRegion{0.0, 0.12};  ///< the place of the stack
inline constexpr Place kGoal{0.16, 0.04};   ///< behind the wall

/// Returns the blocks of a task: "red", "blue".
std::vector<std::string> blocks(Task task);

std::string model_xml(Task task);

}  // namespace manipulation
