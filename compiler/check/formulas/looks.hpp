// In which direction of time an operator looks.
#pragma once

#include "check/model/model.hpp"

namespace etlc::check {

bool looks_ahead(Formula::Kind kind);
bool looks_back(Formula::Kind kind);

}  // namespace etlc::check
