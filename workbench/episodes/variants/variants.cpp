#include "episodes/variants/variants.hpp"

#include <algorithm>
#include <memory>
#include <numeric>
#include <set>

namespace etlc::episodes {

namespace {

/// Returns the frames at which the label becomes another known one.
std::vector<std::uint64_t> changes(const std::vector<Label>& truth) {
    std::vector<std::uint64_t> found;
    Label last = Label::unknown;
    for (std::size_t t = 0; t < truth.size(); ++t) {
        if (truth[t] == Label::unknown) continue;
        if (last != Label::unknown && truth[t] != last) found.push_back(t);
        last = truth[t];
    }
    return found;
}

/// Returns the frames from `begin` up to but not including `end`.
Order range(std::uint64_t begin, std::uint64_t end) {
    Order order(end - begin);
    std::iota(order.begin(), order.end(), begin);
    return order;
}

}  // namespace

std::string_view name_of(Variant variant) {
    for (const auto& [one, name] : kVariants)
        if (one == variant) return name;
    return "";
}

std::vector<Order> orders(Variant variant, const std::vector<std::vector<Label>>& truths,
                          std::uint64_t frames) {
    std::set<std::uint64_t> all;  // a change is never at frame 0
    std::set<std::uint64_t> last;
    for (const std::vector<Label>& truth : truths) {
        const std::vector<std::uint64_t> found = changes(truth);
        all.insert(found.begin(), found.end());
        if (!found.empty()) last.insert(found.back());
    }
    std::vector<Order> result;
    switch (variant) {
        case Variant::cut:
            for (const std::uint64_t change : last) result.push_back(range(0, change));
            break;
        case Variant::frozen:
            for (const std::uint64_t change : last) {
                result.push_back(range(0, frames));
                std::fill(result.back().begin() + static_cast<std::ptrdiff_t>(change),
                          result.back().end(), change - 1);
            }
            break;
        case Variant::phases_reversed: {
            if (all.empty()) break;
            Order& order = result.emplace_back();
            std::uint64_t end = frames;
            all.insert(0);
            for (auto begin = all.rbegin(); begin != all.rend(); end = *begin++) {
                const Order phase = range(*begin, end);
                order.insert(order.end(), phase.begin(), phase.end());
            }
            break;
        }
        case Variant::reversed:
            if (frames < 2) break;
            result.push_back(range(0, frames));
            std::reverse(result.back().begin(), result.back().end());
            break;
    }
    return result;
}

}  // namespace etlc::episodes

namespace etlc::data {

template <class Archive>
void fields(Archive& archive, Sample& sample) {
    std::vector<std::uint8_t> present(sample.present.begin(), sample.present.end());
    archive(sample.values, present);
    sample.present.assign(present.begin(), present.end());
}

}  // namespace etlc::data

namespace etlc::episodes {

/// A trace whose frames are kept.
class KeptFrames::Keeper final : public data::Trace {
public:
    Keeper(std::unique_ptr<data::Trace> trace, data::Spool<data::Sample>& frames)
        : trace_(std::move(trace)), frames_(frames) {}

    diag::Result<bool> next(data::Sample& sample) override {
        auto more = trace_->next(sample);
        if (more && *more) frames_.add(sample);
        return more;
    }
    std::uint64_t length() const override { return trace_->length(); }
    bool has(std::size_t channel) const override { return trace_->has(channel); }

private:
    std::unique_ptr<data::Trace> trace_;
    data::Spool<data::Sample>& frames_;
};

/// Kept frames in the order of a variant.
class KeptFrames::Reordered final : public data::Trace {
public:
    Reordered(const KeptFrames& kept, const Order& order) : kept_(kept), order_(order) {}

    diag::Result<bool> next(data::Sample& sample) override {
        if (next_ == order_.size()) return false;
        sample = kept_.frames_[order_[next_++]];
        return true;
    }
    std::uint64_t length() const override { return order_.size(); }
    bool has(std::size_t channel) const override { return kept_.has_[channel]; }

private:
    const KeptFrames& kept_;
    const Order& order_;
    std::size_t next_ = 0;
};

Opener KeptFrames::keeping(const Opener& open) {
    return [this, &open](const std::vector<data::Channel>& channels)
               -> diag::Result<std::unique_ptr<data::Trace>> {
        auto trace = open(channels);
        if (!trace) return trace;
        has_.clear();
        for (std::size_t c = 0; c < channels.size(); ++c) has_.push_back((*trace)->has(c));
        return std::unique_ptr<data::Trace>(std::make_unique<Keeper>(std::move(*trace), frames_));
    };
}

Opener KeptFrames::in_order(const Order& order) const {
    return [this, &order](const std::vector<data::Channel>&) {
        return diag::Result<std::unique_ptr<data::Trace>>(
            std::make_unique<Reordered>(*this, order));
    };
}

}  // namespace etlc::episodes
