// SPDX-License-Identifier: MIT
// The version of this runtime.
// Gives: ETLMON_VERSION_MAJOR and ETLMON_VERSION_MINOR, which a generated header checks, and
// ETLMON_VERSION_PATCH. Keeps true: headers and runtimes of the same major.minor fit together. A
// change of what generated code calls, or of the layout of its constants, increments minor; any
// other change in a release increments patch.
#pragma once

#define ETLMON_VERSION_MAJOR 0
#define ETLMON_VERSION_MINOR 3
#define ETLMON_VERSION_PATCH 0
