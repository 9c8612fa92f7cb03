// SPDX-License-Identifier: MIT
// Stands in for a part of the runtime's enclosed.hpp when `etlc prove` compiles a class:
// predicate.hpp here has the comparisons.
#pragma once

#include "etlmon/temporal/predicate.hpp"

#define at_most measured_at_most
#define at_least measured_at_least
#include_next "etlmon/distance/enclosed.hpp"
#undef at_most
#undef at_least
