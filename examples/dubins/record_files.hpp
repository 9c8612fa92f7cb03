// Writes a drive as an episode for etlc.
// Takes: the car's states and one embedding each. Gives: px, py and z, as .csv (columns px, py,
// z[0] ... z[31], one row per step) or as .npz, which also holds the camera's pictures. Both throw
// std::runtime_error if the file cannot be written.
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
