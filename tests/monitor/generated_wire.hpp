// Requests to the harness and its answers, as bytes; the protocol is described in
// driver/harness.hpp.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "adaptive.hpp"
#include "check/model/model.hpp"
#include "compare.hpp"
#include "reference/reference.hpp"

namespace etlc::tests {

/// Two traces of the same spec; the monitor runs the first, the second beside it, and the second
/// again after a reset.
struct Request {
    std::uint32_t spec = 0;
    reference::Trace first;
    reference::Trace second;
    Labels first_labels{};  ///< where the spec has adaptive thresholds
    Labels second_labels{};
};
using Answer = std::array<Observed, 3>;

/// A sample's elements, as the class of its input has them.
std::string encode_sample(const check::Input& input, const std::vector<double>& sample);

std::string encode(const check::Model& model, const Request& request);

/// Takes the answer off the front of what the harness wrote. Throws std::out_of_range where the
/// bytes end early.
class Decoder {
public:
    explicit Decoder(const std::string& bytes) : bytes_(bytes) {}

    Answer answer(const check::Model& model, bool explains, const Request& request);
    /// The number of allocations, which ends the answers.
    std::uint64_t allocations();
    bool at_end() const { return position_ == bytes_.size(); }

private:
    const std::string& bytes_;
    std::size_t position_ = 0;

    template <class T>
    T take();
    reference::Verdict verdict();
    std::optional<Observed::Why> why();
    Observed run(const check::Model& model, bool explains, std::size_t steps);
};

}  // namespace etlc::tests
