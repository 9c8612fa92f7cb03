// A drive as an episode for etlc.
// Takes: the car's states and one embedding each. Gives: px, py and z, as .csv (columns px, py,
// z[0] ... z[31], a row a step) or as .npz, which holds the camera's pictures too. Both throw
// std::runtime_error where the file cannot be written.
#pragma once

#include <string>
#include <vector>

#include "encoder.hpp"
#include "world.hpp"

namespace demo {

void write_csv(const std::string& path, const std::vector<Car>& states,
               const std::vector<Embedding>& embeddings);
void write_npz(const std::string& path, const std::vector<Car>& states,
               const std::vector<Embedding>& embeddings);

}  // namespace demo
