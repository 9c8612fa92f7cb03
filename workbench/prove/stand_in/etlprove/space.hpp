// The diagrams of the program that steps a class for `etlc prove`, and the ends of that program.
#pragma once

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#ifdef __linux__
#include <signal.h>
#include <sys/prctl.h>
#endif

#include "etlprove/diagrams.hpp"

namespace etlprove {

/// Ends of the program besides success, as its exit status.
constexpr int kBranches = 10, kExhausted = 11, kNewNumber = 12, kTooMany = 13;
constexpr int kLeftovers = 14;
constexpr uint32_t kMostNodes = 40u << 20;

[[noreturn]] inline void stop(int status) {
    fflush(stdout);
    _Exit(status);
}

/// Ends the program when etlc ends, even if that is killed.
inline void end_with_etlc() {
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
}

inline Diagrams& diagrams() {
    static Diagrams kept(kMostNodes, [] { stop(kExhausted); });
    return kept;
}

}  // namespace etlprove
