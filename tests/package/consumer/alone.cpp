// A monitor whose header contains its runtime, with a flight recorder.
#include "guard.hpp"

int main() {
    guard::Inputs motion;
    motion.speed = 30.0F;  // in range with the constant that CMakeLists.txt sets
    guard::Monitor monitor;
    const bool alarm = monitor.step(motion).limit.alarm();
    monitor.close_incidents();
    return alarm && monitor.incidents() == 1 ? 0 : 1;
}
