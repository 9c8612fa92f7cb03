#include "retargetable.hpp"

#include <fstream>
#include <memory>
#include <stdexcept>

// The examples' name for their monitors: here the retargetable classes.
#define BENCH_RETARGETABLE(spec)     \
    namespace spec##_retargetable {} \
    namespace spec = spec##_retargetable;
BENCH_RETARGETABLE(belt)
BENCH_RETARGETABLE(dock)
BENCH_RETARGETABLE(dubins)
BENCH_RETARGETABLE(example)
BENCH_RETARGETABLE(gauge)
BENCH_RETARGETABLE(grasp)
BENCH_RETARGETABLE(hover)
BENCH_RETARGETABLE(short_rows)

#include "of_short_rows.hpp"
#include "stepped.hpp"

namespace bench {

namespace {

template <class Params>
struct Page {
    alignas(64) char bytes[Params::kSize];
    const unsigned char* begin() const { return reinterpret_cast<const unsigned char*>(bytes); }
};

/// `Params`: those of the example's class, in STEM.params.bin.
template <class Example, class Params>
bool take(const std::string& name, const std::string& stem, Retargetable& result) {
    if (name != Example::kName) return false;
    const auto page = std::make_shared<Page<Params>>();
    std::ifstream file(BENCH_PARAMS "/" + stem + ".params.bin", std::ios::binary);
    file.read(page->bytes, Params::kSize);
    const auto stepped = std::make_shared<SteppedExample<Example>>();
    const auto retarget = [=] {
        return stepped->monitor.retarget(page->begin(), Params::kSize, etlmon::Past::kept);
    };
    if (retarget() != etlmon::ParamsState::ready)
        throw std::runtime_error(stem + ": " + etlmon::words(retarget()));
    result = {[=] { stepped->step(); }, [=] { retarget(); }, Example::Monitor::kStateBytes,
              Params::kSize};
    return true;
}

}  // namespace

Retargetable retargetable(const std::string& name) {
    Retargetable result;
    if (take<PaperExample, example::Params>(name, "example", result) ||
        take<Dubins, dubins::Params>(name, "dubins", result) ||
        take<Dock, dock::Params>(name, "dock", result) ||
        take<Hover, hover::Params>(name, "hover", result) ||
        take<Belt, belt::Params>(name, "belt", result) ||
        take<Gauge, gauge::Params>(name, "gauge", result) ||
        take<Grasp, grasp::Params>(name, "grasp", result) ||
        take<ShortRows, short_rows::Params>(name, "short_rows", result))
        return result;
    throw std::logic_error("no example is called " + name);
}

}  // namespace bench
