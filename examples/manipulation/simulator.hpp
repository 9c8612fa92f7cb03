// Simulates one task in MuJoCo: physics, the gripper's setpoints, and the camera.
// Takes: a task, then setpoints. Gives: positions and images. Keeps true: the same setpoints give
// the same positions; only one thread uses a simulator.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "scene.hpp"

namespace manipulation {

inline constexpr int kSide = 96;       ///< pixels
inline constexpr double kRate = 20.0;  ///< steps per second
/// Row by row from the top, red, green, blue.
using Image = std::vector<std::uint8_t>;
using Position = std::array<double, 3>;

/// The look of an episode; encoders and thresholds are made from the first one.
struct Look {
    Color light{0.55, 0.55, 0.55};
    Color table{0.78, 0.74, 0.68};
    Position camera{0, 0, 0};  ///< moved by this
    bool has_stranger = false;
    Place stranger{0, 0};
};

/// Where the gripper is told to be: its fingers' tips and whether they are closed.
struct Setpoint {
    Position tip{0, -0.1, 0.2};
    bool closed = false;
};

class Simulator {
public:
    /// Throws std::runtime_error if MuJoCo refuses.
    explicit Simulator(Task task);
    ~Simulator();
    Simulator(const Simulator&) = delete;
    Simulator& operator=(const Simulator&) = delete;

    void begin(const std::vector<Place>& blocks, const Look& look, const Setpoint& gripper);
    /// Takes one step of 1/20 s.
    void step(const Setpoint& gripper);
    Position tip() const;
    Position block(std::size_t index) const;
    /// Returns whether both fingers touch it.
    bool is_held(std::size_t index) const;
    Image image() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace manipulation
