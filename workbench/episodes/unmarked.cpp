#include "episodes/unmarked.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "check/encoders/encoders.hpp"

namespace etlc::episodes {
namespace {

/// Unmarked episodes of a call.
class Unmarked {
public:
    void add(const std::string& path, bool is_unmarked) {
        ++episodes_;
        if (!is_unmarked) return;
        if (++count_ == 1) first_ = path;
    }

    void report(diag::Sink& sink) const {
        if (count_ == 0) return;
        diag::Diagnostic& warning = sink.report(data::in_trace(
            {diag::Code::unmarked_episode, "does not say which encoder made its embeddings"},
            first_));
        if (episodes_ > 1)
            warning.note(fmt::format("this is so of {} of {} episodes", count_, episodes_));
        check::explain_unmarked(warning);
    }

private:
    std::string first_;
    std::size_t count_ = 0;
    std::size_t episodes_ = 0;
};

}  // namespace

bool is_unmarked(const check::Model& model, const std::vector<Index>& inputs,
                 const data::NamesInFile& names, const embedded::Marks& marks) {
    return std::any_of(inputs.begin(), inputs.end(), [&](Index index) {
        const check::Input& input = model.inputs[index];
        return check::is_unmarked(input, data::name_in_file(input.name, names), marks);
    });
}

void warn_of_unmarked(const Identities& episodes, diag::Sink& sink) {
    Unmarked unmarked;
    episodes.for_each([&](std::size_t, const Recorded& episode) {
        unmarked.add(episode.path, episode.is_unmarked);
    });
    unmarked.report(sink);
}

void warn_of_unmarked(const check::Model& model, const std::vector<Index>& inputs,
                      const std::vector<std::string>& paths, const data::NamesInFile& names,
                      diag::Sink& sink) {
    if (model.encoders.empty()) return;
    Unmarked unmarked;
    for (const std::string& path : paths) {
        const auto marks = embedded::read_marks(path);
        unmarked.add(path, marks && is_unmarked(model, inputs, names, *marks));
    }
    unmarked.report(sink);
}

}  // namespace etlc::episodes
