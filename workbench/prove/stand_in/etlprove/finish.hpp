// Calls finish() of a class that has it: one with sliding monitors.
#pragma once

namespace etlprove {

template <class Monitor, class Verdicts>
auto finish(Monitor& monitor, int) -> decltype(monitor.finish()) {
    return monitor.finish();
}
template <class Monitor, class Verdicts>
Verdicts finish(Monitor&, long) {
    return {};
}

}  // namespace etlprove
