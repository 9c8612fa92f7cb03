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

/// Two traces of the same spec: the monitor runs the first, a second instance the second, and the
/// first instance runs the second again after a reset.
struct Request {
    std::uint32_t spec = 0;
    reference::Trace first;
    reference::Trace second;
    Labels first_labels{};  ///< if the spec has adaptive thresholds
    Labels second_labels{};
};
using Answer = std::array<Observed, 3>;

/// Returns a sample's elements in the type of the input.
std::string encode_sample(const check::Input& input, const std::vector<double>& sample);

std::string encode(const check::Model& model, const Request& request);

/// Takes the next answer from the harness's output. Throws std::out_of_range if the bytes end
/// early.
class Decoder {
public:
    explicit Decoder(const std::string& bytes) : bytes_(bytes) {}

    Answer answer(const check::Model& model, bool explains, const Request& request);
    /// Reads the number of allocations, which ends the answers.
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
