#include "recorded.hpp"

#include <memory>
#include <stdexcept>

// The examples' name for their monitors: here the classes with a recorder.
#define BENCH_WITH_RECORDER(spec) \
    namespace spec##_recorded {}  \
    namespace spec = spec##_recorded;
BENCH_WITH_RECORDER(belt)
BENCH_WITH_RECORDER(dock)
BENCH_WITH_RECORDER(dubins)
BENCH_WITH_RECORDER(example)
BENCH_WITH_RECORDER(gauge)
BENCH_WITH_RECORDER(grasp)
BENCH_WITH_RECORDER(hover)

#include "stepped.hpp"

namespace bench {

namespace {

template <class Example>
bool take(const std::string& name, Recorded& result) {
    if (name != Example::kName) return false;
    const auto stepped = std::make_shared<SteppedExample<Example>>();
    result = {[=] { stepped->step(); }, Example::Monitor::kStateBytes};
    return true;
}

}  // namespace

Recorded recorded(const std::string& example) {
    Recorded result;
    if (take<PaperExample>(example, result) || take<Dubins>(example, result) ||
        take<Dock>(example, result) || take<Hover>(example, result) ||
        take<Belt>(example, result) || take<Gauge>(example, result) || take<Grasp>(example, result))
        return result;
    throw std::logic_error("no example is called " + example);
}

}  // namespace bench
