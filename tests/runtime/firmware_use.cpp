// Calls every distance, every aggregation and everything else about distances that generated code
// may call, so that a test can check the symbols of its object.
#include "etlmon/distance/enclosed.hpp"
#include "etlmon/distance/kernel.hpp"
#include "etlmon/distance/widen.hpp"
#include "etlmon/temporal/adaptation.hpp"
#include "etlmon/temporal/expression.hpp"
#include "etlmon/version.hpp"
#include "etlmon/views.hpp"

#if ETLMON_VERSION_MAJOR != 0 || ETLMON_VERSION_MINOR != 3
#error "this test was written for another version"
#endif

namespace {

constexpr uint32_t kK = 5, kD = 35;
constexpr uint32_t kManyK = 9, kLongD = 70;
constexpr int8_t kBytes[kManyK * kLongD] = {1};
const float kTargets[kK * kD] = {1.0f, 2.0f};
const float kDiagonal[kD] = {1.0f};
const float kFull[kD * kD] = {1.0f};

template <class Metric>
etlmon::Measured nearest(const float* z) {
    return etlmon::measure<Metric, etlmon::Min, kK, kD>(z, kTargets);
}

etlmon::Measured aggregated(const float* z) {
    using namespace etlmon;
    const Measured a = nearest<L2>(z), b = measure<L2, Max, kK, kD>(z, kTargets);
    const Measured c = measure<L2, Mean, kK, kD>(z, kTargets),
                   d = measure<L2, Kth<3>, kK, kD>(z, kTargets);
    return {smaller(add(a.delta, b.delta), greater(c.delta, root(absolute(d.delta)))), a.nearest};
}

}  // namespace

struct Inputs {
    etlmon::Vector<float, kD> z;
    etlmon::Vector<uint16_t, kD> half;
    etlmon::Vector<int8_t, kD> small;
    float x = etlmon::kMissing;
    etlmon::Flag on;
};

etlmon::Measured distances(const float* z, int which);
bool usable(const Inputs& in);
etlmon::Enclosed on_bytes(const float* z);
void widen(const Inputs& in, float* to);
void observe(float& threshold, const float& distance, bool truth, const etlmon::Adaptation& by);

etlmon::Measured distances(const float* z, int which) {
    using namespace etlmon;
    switch (which) {
        case 0: return aggregated(z);
        case 1: return nearest<L2Sq>(z);
        case 2: return nearest<L1>(z);
        case 3: return nearest<Linf>(z);
        case 4: return nearest<Cosine>(z);
        case 5: return measure<Mahalanobis, Min, kK, kD>(z, kTargets, kFull);
        case 6: return measure<MahalanobisDiagonal, Mean, kK, kD>(z, kTargets, kDiagonal);
#if defined(WITH_ANGULAR)
        case 7: return nearest<Angular>(z);
#endif
        default: return {negate(divide(multiply(z[0], z[1]), subtract(z[0], z[1]))), 0};
    }
}

etlmon::Enclosed on_bytes(const float* z) {
    using namespace etlmon;
    const Enclosed a =
        enclose<L2>(measure_scaled<L2, Min, kManyK, kLongD, kBytes>(z, 0.5f), 0.25f, kLongD);
    const Enclosed b = enclose<L2Sq>(measure_scaled<L2Sq, Mean, kManyK, kLongD, kBytes>(z, 0.5f),
                                     0.25f, kLongD, kManyK);
    const Enclosed c = enclose<Cosine>(
        measure_scaled<Cosine, Kth<3>, kManyK, kLongD, kBytes>(z, 0.5f), 0.125f, kLongD);
    return a.doubtful({1.0f}) ? b.doubtful({1.0f}) ? c : b : a;
}

bool usable(const Inputs& in) {
    return present(in.z) && present(in.half) && present(in.small) &&
           !etlmon::is_nan(etlmon::accept(in.x, 0.0f, 1.0f)) && present(in.on) && in.on.value();
}

void widen(const Inputs& in, float* to) {
    etlmon::widen_f16(in.half.data(), to, kD);
    etlmon::widen_i8(in.small.data(), 0.5f, to, kD);
}

void observe(float& threshold, const float& distance, bool truth, const etlmon::Adaptation& by) {
    if (truth) threshold = etlmon::adapted(threshold, etlmon::is_at_most(distance, threshold), by);
    threshold = etlmon::restored(distance, threshold, by);
}
