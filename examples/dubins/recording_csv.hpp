// A drive as a trace for etlc: columns px, py, z[0] ... z[31], a row a step.
#pragma once

#include <string>
#include <vector>

#include "encoder.hpp"
#include "world.hpp"

namespace demo {

/// One embedding a state. Throws std::runtime_error where the file cannot be written.
void write_csv(const std::string& path, const std::vector<Car>& states,
               const std::vector<Embedding>& embeddings);

}  // namespace demo
