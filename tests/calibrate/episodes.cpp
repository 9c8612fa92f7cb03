#include "episodes.hpp"

#include <memory>

#include "data/traces/trace_formats.hpp"

namespace etlc::tests {

namespace {

/// A trace that keeps its text alive.
class Kept final : public data::Trace {
public:
    Kept(std::shared_ptr<std::string> text, std::unique_ptr<data::Trace> trace)
        : text_(std::move(text)), trace_(std::move(trace)) {}
    diag::Result<bool> next(data::Sample& sample) override { return trace_->next(sample); }
    bool has(std::size_t channel) const override { return trace_->has(channel); }

private:
    std::shared_ptr<std::string> text_;
    std::unique_ptr<data::Trace> trace_;
};

}  // namespace

episodes::Opener csv_episode(std::string text) {
    auto shared = std::make_shared<std::string>(std::move(text));
    return [shared](const std::vector<data::Channel>& channels)
               -> diag::Result<std::unique_ptr<data::Trace>> {
        auto trace = data::open_csv_trace(data::from_memory(*shared), channels);
        if (!trace) return trace.failure();
        return std::unique_ptr<data::Trace>(std::make_unique<Kept>(shared, std::move(*trace)));
    };
}

std::string labels(const episodes::Wanted& wanted, const episodes::Opener& open,
                   episodes::Index predicate) {
    auto recording = episodes::Recording::open(wanted, open);
    if (!recording) return recording.failure().message;
    std::string result;
    for (;;) {
        const auto more = recording->next();
        if (!more) return more.failure().message;
        if (!*more) return result;
        const episodes::Label label = recording->label(predicate);
        result += result.empty() ? "" : " ";
        result += label == episodes::Label::yes ? "y" : label == episodes::Label::no ? "n" : "?";
    }
}

}  // namespace etlc::tests
