// The members of a class, by the text of its header: those that count steps, and whether there may
// be anything else that it remembers.
#pragma once

#include <string>

namespace etlc::prove {

/// Makes the members that count steps counters that say how they are used
/// (stand_in/etlprove/uses.hpp).
std::string with_counters(const std::string& header);

/// Whether a header may have variables besides the members of its class.
bool may_hide_state(const std::string& header);

}  // namespace etlc::prove
