#include "scene.hpp"

#include <fmt/core.h>

namespace manipulation {

namespace {

std::string zone(std::string_view name, Place at, Color color) {
    return fmt::format(
        R"(<geom name="{}" type="box" size="{} {} 0.001" pos="{} {} 0" rgba="{} {} {} 1"
            contype="0" conaffinity="0"/>)",
        name, kZone, kZone, at[0], at[1], color[0], color[1], color[2]);
}

std::string zones(Task task) {
    switch (task) {
        case Task::sorting:
            return zone("red_zone", kRedZone, {0.9, 0.55, 0.5}) +
                   zone("blue_zone", kBlueZone, {0.5, 0.6, 0.9});
        case Task::stacking: return zone("region", kRegion, {0.55, 0.8, 0.55});
        case Task::pick_place: break;
    }
    return zone("goal", kGoal, {0.55, 0.8, 0.55}) +
           fmt::format(R"(<geom name="wall" type="box" size="0.012 0.16 {0}" pos="0 0.04 {0}"
                          rgba="0.55 0.45 0.4 1"/>)",
                       kWall / 2);
}

std::string block(std::string_view name) {
    const Color color = name == "red" ? Color{0.85, 0.12, 0.1} : Color{0.1, 0.2, 0.85};
    return fmt::format(
        R"(<body name="{}" pos="0 0 {}"><freejoint/>
             <geom name="{}" type="box" size="{} {} {}" rgba="{} {} {} 1" mass="0.05"
                   friction="1.5 0.02 0.001" condim="4"/></body>)",
        name, kBlock / 2, name, kBlock / 2, kBlock / 2, kBlock / 2, color[0], color[1], color[2]);
}

constexpr std::string_view kFinger =
    R"(<body name="{0}" pos="{1} 0 0"><joint name="{0}" type="slide" axis="{2} 0 0"
         range="-0.005 0.04" damping="5"/>
         <geom name="{0}" type="box" size="0.006 0.014 0.03" pos="0 0 0.015" mass="0.05"
               rgba="0.2 0.2 0.22 1" friction="2 0.05 0.001" condim="4"/></body>)";

std::string gripper() {
    std::string joints;
    for (const char* axis : {"x", "y", "z"})
        joints +=
            fmt::format(R"(<joint name="{}" type="slide" axis="{} {} {}" damping="90"/>)", axis,
                        axis[0] == 'x' ? 1 : 0, axis[0] == 'y' ? 1 : 0, axis[0] == 'z' ? 1 : 0);
    return R"(<body name="hand" pos="0 0 0">)" + joints +
           R"(<geom name="palm" type="box" size="0.06 0.025 0.012" pos="0 0 0.057" mass="0.4"
                rgba="0.35 0.35 0.38 1" contype="0" conaffinity="0"/>
              <geom name="arm" type="cylinder" size="0.018 0.15" pos="0 0 0.21" mass="0.1"
                rgba="0.6 0.6 0.62 1" contype="0" conaffinity="0"/>)" +
           fmt::format(fmt::runtime(kFinger), "left", -0.02, -1) +
           fmt::format(fmt::runtime(kFinger), "right", 0.02, 1) + "</body>";
}

}  // namespace

std::vector<std::string> blocks(Task task) {
    if (task == Task::pick_place) return {"red"};
    return {"red", "blue"};
}

std::string model_xml(Task task) {
    std::string bodies = zones(task) + gripper();
    for (const std::string& name : blocks(task)) bodies += block(name);
    return fmt::format(R"(
<mujoco>
  <compiler autolimits="true"/>
  <option timestep="0.004" iterations="20"/>
  <visual><global offwidth="96" offheight="96"/><quality shadowsize="0" offsamples="0"/>
    <headlight ambient="0.35 0.35 0.35" diffuse="0.25 0.25 0.25" specular="0 0 0"/></visual>
  <worldbody>
    <light name="lamp" pos="0.2 -0.3 1.2" dir="-0.15 0.25 -1" directional="true" castshadow="false"
           diffuse="0.55 0.55 0.55" specular="0.1 0.1 0.1"/>
    <camera name="camera" pos="0 -0.36 0.5" xyaxes="1 0 0 0 0.5 0.42" fovy="46"/>
    <geom name="table" type="plane" size="0.45 0.4 0.1" rgba="0.78 0.74 0.68 1"/>
    <geom name="stranger" type="cylinder" size="0.03 0.04" pos="0 0 -1" rgba="0.9 0.75 0.1 1"
          contype="0" conaffinity="0"/>
    {}
  </worldbody>
  <actuator>
    <position joint="x" kp="900"/><position joint="y" kp="900"/><position joint="z" kp="3000"/>
    <position joint="left" kp="150"/><position joint="right" kp="150"/>
  </actuator>
</mujoco>)",
                       bodies);
}

}  // namespace manipulation
