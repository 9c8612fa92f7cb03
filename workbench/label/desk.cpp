#include "label/desk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "data/files/file.hpp"
#include "data/text/text.hpp"
#include "execute/inputs.hpp"
#include "recordings/episodes.hpp"
#include "recordings/open.hpp"

namespace etlc::label {

namespace {

namespace fs = std::filesystem;
using diag::Code;
using diag::Failure;
using episodes::Label;
using episodes::LabelledSteps;

bool is_own_truth(const check::Predicate& predicate) {
    return predicate.distances().empty() &&
           predicate.threshold.origin == check::ThresholdOrigin::literal;
}

/// Returns the number of steps of an episode, and which of the channels it has.
diag::Result<std::pair<std::uint64_t, std::vector<bool>>> measured(
    const std::string& path, const std::vector<data::Channel>& channels) {
    const auto trace = recordings::open_trace(path, channels);
    if (!trace) return trace.failure();
    std::vector<bool> has;
    for (std::size_t c = 0; c < channels.size(); ++c) has.push_back((*trace)->has(c));
    std::uint64_t steps = (*trace)->length();
    data::Sample sample;
    for (bool is_known = steps > 0; !is_known; ++steps) {
        const auto more = (*trace)->next(sample);
        if (!more) return more.failure();
        if (!*more) break;
    }
    if (steps == 0) return recordings::no_steps();
    return std::pair{steps, has};
}

bool has_changed(const std::vector<Table>& tables) {
    return std::any_of(tables.begin(), tables.end(),
                       [](const Table& table) { return table.has_changed(); });
}

/// Says what the first error of a sink says, with its place.
Failure first_error(const diag::Sink& sink) {
    for (const diag::Diagnostic& one : sink.sorted()) {
        if (one.severity() != diag::Severity::error) continue;
        const std::string line = one.line > 0 ? fmt::format(":{}", one.line) : "";
        return {one.code, fmt::format("{}{}: {}", one.file, line, one.message)};
    }
    return {Code::unreadable_trace, "the labels cannot be read"};
}

}  // namespace

std::vector<Index> predicates_to_label(const check::Model& model) {
    std::vector<Index> named;
    std::vector<Index> found;
    for (Index p = 0; p < model.predicates.size(); ++p) {
        const check::Predicate& predicate = model.predicates[p];
        if (predicate.name.empty()) continue;
        named.push_back(p);
        const bool has_truth = std::any_of(model.truths.begin(), model.truths.end(),
                                           [&](const auto& truth) { return truth.predicate == p; });
        if (!has_truth && !is_own_truth(predicate)) found.push_back(p);
    }
    return found.empty() ? named : found;
}

Desk::Desk(const check::Model& model, DeskRequest request)
    : model_(&model), request_(std::move(request)), predicates_(predicates_to_label(model)) {}

std::optional<Desk> Desk::open(const check::Model& model, DeskRequest request, diag::Sink& sink) {
    Desk desk(model, std::move(request));
    if (desk.predicates_.empty()) {
        sink.report(Code::nothing_to_label, model.monitors.front().span,
                    "the spec has no predicate with a name, which a label could be about");
        return std::nullopt;
    }
    if (!desk.measure(sink)) return std::nullopt;
    desk.place();
    if (!desk.read(sink)) return std::nullopt;
    return desk;
}

const std::string& Desk::predicate(std::size_t p) const {
    return model_->predicates[predicates_[p]].name;
}

bool Desk::is_labelled(std::size_t episode) const {
    const Episode& of = episodes_[episode];
    for (std::size_t p = 0; p < predicates_.size(); ++p)
        if (!marks_[episode][p] && !of.is_recorded[p]) return false;
    return true;
}

/// Finds the length of each episode, and the labels that recordings have.
bool Desk::measure(diag::Sink& sink) {
    std::vector<data::Channel> channels;
    std::set<Index> inputs;  // they give the number of steps
    for (std::size_t p = 0; p < predicates_.size(); ++p) {
        channels.push_back({"truth." + predicate(p), data::Channel::Kind::boolean, 1, true});
        const auto& read = model_->predicates[predicates_[p]].inputs;
        inputs.insert(read.begin(), read.end());
    }
    for (const Index input : inputs) channels.push_back(execute::channel_of(model_->inputs[input]));
    channels = recordings::renamed(std::move(channels), request_.names);
    for (const std::string& path : request_.episodes) {
        auto found = measured(path, channels);
        if (!found) {
            sink.report(recordings::in_trace(found.failure(), path));
            continue;
        }
        auto& [steps, has] = *found;
        has.resize(predicates_.size());
        episodes_.push_back({path, "", steps, 0, std::move(has)});
    }
    return !sink.has_errors();
}

/// Finds the table of each episode, and its name there.
void Desk::place() {
    std::map<std::string, std::vector<std::size_t>> folders;
    for (std::size_t e = 0; e < episodes_.size(); ++e) {
        const std::string& path = episodes_[e].path;
        folders[request_.table.empty() ? episodes::folder_of(path) : ""].push_back(e);
    }
    for (const auto& [folder, inside] : folders) {
        std::vector<std::string> paths;
        for (const std::size_t e : inside) paths.push_back(episodes_[e].path);
        // A table beside episodes is about these alone, so that shorter names tell them apart.
        const std::vector<std::string> names = episodes::shortest_names(paths);
        for (std::size_t i = 0; i < inside.size(); ++i) {
            episodes_[inside[i]].table = paths_.size();
            episodes_[inside[i]].name = names[i];
        }
        paths_.push_back(request_.table.empty()
                             ? (fs::path(folder) / recordings::kLabelsFile).string()
                             : request_.table);
    }
}

/// Reads the tables, whose bytes are compared before they are replaced, and the labels in them.
/// Both have to be of the same bytes: they are read again where another program has written
/// meanwhile.
bool Desk::read(diag::Sink& sink) {
    constexpr int kMostReads = 20;
    for (int i = 0; i < kMostReads; ++i) {
        std::vector<diag::Result<Table>> found = read_tables();
        const std::shared_ptr<const episodes::LabelSet> labels = read_labels(sink);
        if (sink.has_errors()) return false;
        std::vector<Table> tables;
        for (std::size_t t = 0; t < found.size(); ++t) {
            if (!found[t]) {
                sink.report(data::in_file(found[t].failure(), paths_[t]));
                return false;
            }
            tables.push_back(std::move(*found[t]));
        }
        if (has_changed(tables)) continue;
        if (!take(labels.get(), sink)) return false;
        tables_ = std::move(tables);
        changes_.clear();
        undone_.clear();
        ++version_;
        return true;
    }
    sink.report(data::in_file(
        {Code::unreadable_trace, "cannot be read: another program changes it all the time"},
        paths_.front()));
    return false;
}

std::vector<diag::Result<Table>> Desk::read_tables() const {
    std::vector<diag::Result<Table>> tables;
    for (std::size_t t = 0; t < paths_.size(); ++t) {
        std::vector<std::string> inside;
        for (const Episode& episode : episodes_)
            if (episode.table == t) inside.push_back(episode.path);
        tables.push_back(Table::read(paths_[t], inside, model_->step_seconds));
    }
    return tables;
}

std::shared_ptr<const episodes::LabelSet> Desk::read_labels(diag::Sink& sink) const {
    episodes::LabelSources sources;
    std::error_code ignored;
    if (!request_.table.empty() && fs::exists(request_.table, ignored))
        sources.tables = {request_.table};
    if (!request_.table.empty() && sources.tables.empty()) return nullptr;
    return episodes::LabelSet::read(sources, {model_}, request_.episodes, sink);
}

/// Takes the labels of the tables, in which only the length of the episodes was not checked.
bool Desk::take(const episodes::LabelSet* labels, diag::Sink& sink) {
    std::vector<std::vector<Marks>> marks(episodes_.size(), std::vector<Marks>(predicates_.size()));
    for (std::size_t e = 0; e < episodes_.size() && labels != nullptr; ++e) {
        const Episode& episode = episodes_[e];
        const episodes::EpisodeLabels* const of = labels->of(episode.path);
        for (std::size_t p = 0; p < predicates_.size() && of != nullptr; ++p) {
            const auto found = of->find(predicate(p));
            if (found == of->end()) continue;
            const LabelledSteps& first = found->second.front();
            const LabelledSteps& last = found->second.back();
            const bool is_open = last.end == LabelledSteps::kToTheEnd;
            const std::uint64_t step = is_open ? last.start : last.end - 1;
            if (episode.is_recorded[p])
                sink.report(recordings::in_trace(
                    {Code::contradictory_labels,
                     fmt::format("has an array {}, and {} labels {} too: remove one of them",
                                 data::in_quotes(recordings::name_in_file("truth." + predicate(p),
                                                                          request_.names)),
                                 first.place, data::in_quotes(predicate(p)))},
                    episode.path));
            if (step >= episode.steps)
                sink.report(recordings::in_trace(
                    {Code::nothing_to_label,
                     fmt::format("{} labels {} at step {}, and the last step is {}", last.place,
                                 data::in_quotes(predicate(p)), step, episode.steps - 1)},
                    episode.path));
            marks[e][p].emplace();
            for (const LabelledSteps& one : found->second)
                if (one.label != Label::no)
                    marks[e][p]->push_back(
                        {one.start, std::min(one.end, episode.steps), one.label});
        }
    }
    if (sink.has_errors()) return false;
    marks_ = std::move(marks);
    return true;
}

/// Writes labels of an episode, and takes them once they are written.
std::optional<Failure> Desk::put(std::size_t episode,
                                 const std::vector<std::pair<std::size_t, Marks>>& labels) {
    const Episode& of = episodes_[episode];
    std::vector<LabelsOf> all;
    for (const auto& [p, marks] : labels)
        all.push_back({of.path, of.name, predicate(p), of.steps, marks});
    Table& table = tables_[of.table];
    if (auto failure = table.write(all))
        return Failure{failure->code, fmt::format("{}: {}", table.path(), failure->message)};
    for (const auto& [p, marks] : labels) marks_[episode][p] = marks;
    ++version_;
    return std::nullopt;
}

std::optional<Failure> Desk::change(std::size_t episode,
                                    std::vector<std::pair<std::size_t, Marks>> labels) {
    Change change{episode, {}};
    std::erase_if(labels,
                  [&](const auto& one) { return marks_[episode][one.first] == one.second; });
    if (labels.empty()) return std::nullopt;
    for (const auto& [p, marks] : labels) change.before.emplace_back(p, marks_[episode][p]);
    if (auto failure = put(episode, labels)) return failure;
    changes_.push_back(std::move(change));
    undone_.clear();
    return std::nullopt;
}

std::optional<Failure> Desk::press(std::size_t episode, std::size_t p, Key key,
                                   std::uint64_t step) {
    const Episode& of = episodes_[episode];
    if (of.is_recorded[p])
        return Failure{Code::contradictory_labels,
                       fmt::format("{} has an array {}: its labels cannot be changed here", of.path,
                                   data::in_quotes("truth." + predicate(p)))};
    return change(episode, {{p, after_key(marks_[episode][p], key, step, of.steps)}});
}

std::optional<Failure> Desk::accept(std::size_t episode, const std::vector<Marks>& proposed) {
    std::vector<std::pair<std::size_t, Marks>> labels;
    for (std::size_t p = 0; p < predicates_.size() && p < proposed.size(); ++p)
        if (proposed[p] && !marks_[episode][p] && !episodes_[episode].is_recorded[p])
            labels.emplace_back(p, proposed[p]);
    return change(episode, std::move(labels));
}

/// Puts back what the last change of `from` has replaced, and adds a change to `to` that undoes
/// this.
diag::Result<std::optional<std::size_t>> Desk::take_back(std::vector<Change>& from,
                                                         std::vector<Change>& to) {
    if (from.empty()) return std::optional<std::size_t>();
    const std::size_t episode = from.back().episode;
    Change back{episode, {}};
    for (const auto& [p, before] : from.back().before)
        back.before.emplace_back(p, marks_[episode][p]);
    if (auto failure = put(episode, from.back().before)) return *failure;
    from.pop_back();
    to.push_back(std::move(back));
    return std::optional(episode);
}

bool Desk::have_tables_changed() const {
    return has_changed(tables_);
}

std::optional<Failure> Desk::reload() {
    diag::Sink sink;
    if (read(sink)) return std::nullopt;
    return first_error(sink);
}

}  // namespace etlc::label
