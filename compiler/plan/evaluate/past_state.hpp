// The state of a number that earlier steps have a part in, with the runtime's arithmetic: the bits
// of generated code. Memory is allocated by the constructor.
#pragma once

#include <cstdint>
#include <vector>

#include "check/model/model.hpp"
#include "etlmon/past/numbers.hpp"

namespace etlc::plan {

class PastState {
public:
    explicit PastState(const check::Past& past);

    void reset();
    /// Takes the value of its expression at this step, NaN where it is missing. Returns the number.
    float push(float x);

    /// Passes its numbers to an archive (archive.hpp).
    template <class Self, class Archive>
    static void visit(Self& self, Archive& archive) {
        archive.fixed(self.bits_);
        archive.fixed(self.keys_);
        archive.number(self.mean_);
        archive.number(self.cursor_);
        archive.number(self.count_);
    }
    /// Returns whether all cursors are inside, as after any number of steps.
    bool fits() const;

private:
    using Kind = check::Past::Kind;

    Kind kind_;
    std::uint32_t steps_;
    std::vector<std::uint32_t> bits_;  ///< of a delay or mean
    std::vector<etlmon::Key> keys_;    ///< of a min or max
    etlmon::MeanState mean_{};
    std::uint32_t cursor_ = 0;
    std::uint32_t count_ = 0;
};

}  // namespace etlc::plan
