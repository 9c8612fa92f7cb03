// Reads a step of a recorded drive, for programs that need only a generated header.
// Takes: a row of a .csv file of dubins_record, columns px, py, z[0] ... z[31]. Gives: its numbers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdlib>
#include <string>

struct Frame {
    double px = 0;
    double py = 0;
    std::array<float, 32> z{};

    bool within(double x, double y, double radius) const {
        return (px - x) * (px - x) + (py - y) * (py - y) < radius * radius;
    }
};

/// Returns false if the row is too short or contains text that is not a number.
inline bool read(const std::string& row, Frame& frame) {
    const char* at = row.c_str();
    char* end = nullptr;
    const auto number = [&] {
        const double value = std::strtod(at, &end);
        const bool sound = end != at;
        at = *end == ',' ? end + 1 : end;
        if (!sound) at = nullptr;
        return value;
    };
    frame.px = number();
    if (at != nullptr) frame.py = number();
    for (std::size_t i = 0; i < frame.z.size() && at != nullptr; ++i)
        frame.z[i] = static_cast<float>(number());
    return at != nullptr;
}
