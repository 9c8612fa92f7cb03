#include "copilot/copilot.hpp"

#ifdef ETLC_HAS_COPILOT

namespace {
float now = 0;  ///< the arguments of the last step's trigger
}

extern "C" {
float copilot_p, copilot_q, copilot_r;
#define BENCH_COPILOT(NAME)                \
    void copilot_##NAME##_step();          \
    void copilot_##NAME##_rho(float rho) { \
        now = rho;                         \
    }
BENCH_COPILOT(invariant)
BENCH_COPILOT(eventually_50)
BENCH_COPILOT(sequence)
BENCH_COPILOT(response_50)
#undef BENCH_COPILOT
}

namespace bench {
namespace {

template <void (*step)()>
float stepped(const Signals& signals, std::size_t i) {
    copilot_p = signals.p[i];
    copilot_q = signals.q[i];
    copilot_r = signals.r[i];
    step();
    return now;
}

}  // namespace

std::optional<CopilotStep> copilot_step(const std::string& title) {
    if (title == "G p") return stepped<copilot_invariant_step>;
    if (title == "F[0,50] p, sliding") return stepped<copilot_eventually_50_step>;
    if (title == "F (p && F (q && F r))") return stepped<copilot_sequence_step>;
    if (title == "G (p -> F[0,50] q)") return stepped<copilot_response_50_step>;
    return std::nullopt;
}

}  // namespace bench

#else

std::optional<bench::CopilotStep> bench::copilot_step(const std::string&) {
    return std::nullopt;
}

#endif
