// Converts recorded numbers to the samples that a monitor gets: a float16 rounds once to float16,
// an int8 is scaled in float32. Whether a sample counts as missing (not finite, out of range) is up
// to the evaluator, as to the generated class.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "data/traces/trace.hpp"

namespace etlc::execute {

/// A sample of one input; without values where missing.
struct Sample {
    bool present = false;
    std::vector<float> values;
    bool is_stale = false;  ///< missing, because it came too often in a row
};

/// Returns the channel of an input in a recording.
data::Channel channel_of(const check::Input& input);

/// Returns the sample, or nothing where a number is not of the input's type; sets `why` to what was
/// found and expected. `reused`: an earlier one, whose memory it takes.
std::optional<Sample> narrow(const check::Input& input, bool present,
                             const std::vector<double>& numbers, std::string& why,
                             Sample reused = {});

/// Returns whether all elements are finite, as etlmon::finite() does, with the widest vectors of
/// this machine: embeddings are long.
bool all_finite(const float* elements, std::size_t count);

/// Applies `stale after N` to the samples of one input.
class Freshness {
public:
    /// Makes room, so that no later call allocates.
    void reserve(std::uint32_t dimension) { last_.reserve(dimension); }
    void reset() { repeats_ = 0; }
    /// Takes the next sample that is present, finite and in range; returns whether it is used.
    bool accepts(const check::Input& input, std::span<const float> values);

    /// Passes its numbers to an archive (archive.hpp).
    template <class Self, class Archive>
    static void visit(Self& self, Archive& archive) {
        archive.some(self.last_);
        archive.number(self.repeats_);
    }
    bool fits(const check::Input& input) const {
        return (last_.empty() || last_.size() == input.dimension) &&
               repeats_ <= input.stale_after && (repeats_ == 0 || !last_.empty());
    }

private:
    std::vector<float> last_;
    std::uint32_t repeats_ = 0;  ///< times that it was used in a row; 0: there is none
};

}  // namespace etlc::execute
