// SPDX-License-Identifier: MIT
// The version of this runtime.
// Takes nothing. Gives: ETLMON_VERSION_MAJOR and ETLMON_VERSION_MINOR, which a generated header
// compares in its first lines,
//   #if ETLMON_VERSION_MAJOR != 0 || ETLMON_VERSION_MINOR != 1
//   #error "made by etlc 0.1: generate it again, or use the runtime it was made for"
//   #endif
// Keeps true: headers and runtimes of one major.minor fit together; anything that changes what
// generated code calls, or the layout of its constants, raises minor.
#pragma once

#define ETLMON_VERSION_MAJOR 0
#define ETLMON_VERSION_MINOR 2
