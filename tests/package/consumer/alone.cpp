// One monitor whose header holds the runtime that it needs.
#include "guard.hpp"

int main() {
    guard::Inputs motion;
    motion.speed = 3.0F;
    guard::Monitor monitor;
    return monitor.step(motion).limit.violated() ? 0 : 1;
}
