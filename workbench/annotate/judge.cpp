#include "annotate/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "check/formulas/horizons.hpp"
#include "check/model/elision.hpp"
#include "data/files/file.hpp"
#include "data/text/text.hpp"
#include "episodes/recording.hpp"
#include "evaluate/episode_scores.hpp"
#include "recordings/datasets/trace.hpp"

namespace etlc::annotate {

namespace {

using check::Formula;
using check::Index;
using diag::Code;

/// A wrong name in an option.
bool wrong(const std::string& option, const std::string& why, diag::Sink& sink,
           Code code = Code::not_annotated) {
    sink.report(data::in_file({code, why}, option));
    return false;
}

std::string unknown(const char* what, const std::string& name,
                    const std::vector<std::string>& known) {
    const std::string meant = data::suggestion(name, known);
    return fmt::format("the spec has no {} {}{}", what, data::in_quotes(name),
                       meant.empty() ? fmt::format(", it has {}", data::listed(known)) : meant);
}

template <class Things>
std::vector<std::string> names_of(const Things& things) {
    std::vector<std::string> names;
    for (const auto& thing : things)
        if (!thing.name.empty()) names.push_back(thing.name);
    return names;
}

/// The model with a let for every formula whose value is wanted at each row.
class Watched {
public:
    Watched(const check::Model& model, const Wanted& wanted, diag::Sink& sink)
        : model(model), reaches_(check::reaches(model)), sink_(sink) {
        ok = find_success(wanted.success) && add_subtasks(wanted.subtasks) &&
             add_phases(wanted.progress);
    }

    check::Model model;
    bool ok = false;
    std::optional<Index> success;
    std::vector<Index> subtasks;  ///< lets
    std::vector<Index> phases;    ///< lets
    std::vector<std::string> phase_texts;

private:
    std::optional<Index> monitor(const std::string& name, const char* option) {
        for (Index m = 0; m < model.monitors.size(); ++m)
            if (model.monitors[m].name == name) {
                const check::Monitor& found = model.monitors[m];
                if (!found.sliding && found.restarts == check::Restarts::never) return m;
                wrong(option,
                      fmt::format("'{}' judges again and again, expected a monitor that "
                                  "judges the episode as a whole",
                                  name),
                      sink_);
                return std::nullopt;
            }
        wrong(option, unknown("monitor", name, names_of(model.monitors)), sink_,
              Code::no_such_monitor);
        return std::nullopt;
    }

    bool find_success(const std::string& name) {
        if (!name.empty()) success = monitor(name, "--success");
        return name.empty() || success;
    }

    Index append(Formula::Kind kind, Index index, std::vector<Index> operands) {
        Formula formula;
        formula.kind = kind;
        formula.index = index;
        formula.operands = std::move(operands);
        model.formulas.push_back(std::move(formula));
        return static_cast<Index>(model.formulas.size() - 1);
    }

    Index watch(const std::string& name, Index formula) {
        check::Let let{name, formula, {}};
        let.telemetry = true;
        model.lets.push_back(std::move(let));
        return static_cast<Index>(model.lets.size() - 1);
    }

    bool add_subtasks(const std::vector<std::string>& names) {
        const std::size_t lets = model.lets.size();
        for (const std::string& name : names) {
            const std::size_t before = subtasks.size();
            for (Index p = 0; p < model.predicates.size(); ++p)
                if (model.predicates[p].name == name)
                    subtasks.push_back(watch(name, append(Formula::Kind::predicate, p, {})));
            for (Index l = 0; l < lets; ++l) {
                const Index formula = model.lets[l].formula;
                if (model.lets[l].name != name || formula == check::kNone) continue;
                if (reaches_[formula].future != check::kNone)
                    return wrong(
                        "--subtasks",
                        fmt::format("'{}' looks ahead, so it has no value at its own step", name),
                        sink_);
                subtasks.push_back(watch(name, formula));
            }
            if (subtasks.size() > before) continue;
            std::vector<std::string> known = names_of(model.predicates);
            for (std::size_t l = 0; l < lets; ++l) known.push_back(model.lets[l].name);
            return wrong("--subtasks", unknown("predicate or let", name, known), sink_);
        }
        return true;
    }

    bool add_phases(const std::string& name) {
        if (name.empty()) return true;
        const auto found = monitor(name, "--progress");
        if (!found) return false;
        const auto stages = evaluate::stages_of(model, model.monitors[*found].formula);
        if (stages.empty())
            return wrong("--progress",
                         fmt::format("'{}' is no sequence of phases: expected F (a && F (b && "
                                     "...)), without times",
                                     name),
                         sink_);
        for (const std::vector<Index>& stage : stages) {
            const Index formula =
                stage.size() == 1 ? stage[0] : append(Formula::Kind::conjunction, 0, stage);
            phase_texts.push_back(check::shown(model, formula));
            phases.push_back(watch("", formula));
        }
        return true;
    }

    std::vector<check::Reach> reaches_;
    diag::Sink& sink_;
};

/// Follows one episode.
class Reader {
public:
    Reader(const Watched& watched, const plan::Plan& plan)
        : watched_(watched), plan_(plan), follower_(plan) {
        let_at_.resize(watched.model.lets.size());
        for (std::size_t i = 0; i < plan.lets.size(); ++i) let_at_[plan.lets[i].index] = i;
    }

    diag::Result<Episode> read(const std::string& path, std::uint64_t rows,
                               const recordings::NamesInFile& names) {
        episode_ = {};
        row_ = 0;
        fulfilled_.reset();
        begin_phase();
        auto recording =
            episodes::Recording::open({plan_.model, plan_.inputs}, path, {names, nullptr});
        if (!recording) return recording.failure();
        const auto done = episodes::replay(*recording, {&follower_}, [&] {
            note();
            ++row_;
            return true;
        });
        if (!done) return done.failure();
        if (row_ != rows)
            return diag::Failure{Code::not_annotated, fmt::format("has {}, the episode has {}",
                                                                  diag::counted(row_, "step"),
                                                                  diag::counted(rows, "row"))};
        episode_.rows = row_;
        note_end();
        return std::move(episode_);
    }

private:
    const etlmon::Verdict& let(Index l) const { return follower_.evaluator().lets()[let_at_[l]]; }

    void note() {
        if (watched_.success && !fulfilled_ && follower_.verdict(*watched_.success).fulfilled())
            fulfilled_ = row_;
        note_subtask();
        if (!watched_.phases.empty()) note_phase();
    }

    /// Notes where the last of those that hold, or none of them, begins.
    void note_subtask() {
        std::size_t now = watched_.subtasks.size();
        for (std::size_t s = 0; s < watched_.subtasks.size(); ++s)
            if (let(watched_.subtasks[s]).satisfied()) now = s;
        auto& all = episode_.subtasks;
        if (all.empty() || now != all.back().second) all.emplace_back(row_, now);
    }

    void begin_phase() {
        share_ = 0;
        first_.reset();
    }

    void note_phase() {
        std::vector<std::uint64_t>& reached = episode_.reached;
        while (reached.size() < watched_.phases.size() &&
               let(watched_.phases[reached.size()]).satisfied()) {
            reached.push_back(row_);
            begin_phase();
        }
        if (reached.size() < watched_.phases.size()) {
            const etlmon::Verdict& next = let(watched_.phases[reached.size()]);
            if (!first_ && !next.unknown()) first_ = next.robustness;
            if (first_ && !next.unknown() && std::isfinite(*first_))
                share_ = std::max(share_, std::clamp(1 - next.robustness / *first_, 0.0F, 1.0F));
        }
        episode_.places.push_back({static_cast<std::uint32_t>(reached.size()), share_});
    }

    /// A row tells what its action led to, which the next row shows.
    void note_end() {
        if (!watched_.success || row_ == 0) return;
        const etlmon::Verdict& last = follower_.verdict(*watched_.success);
        if (last.satisfied()) episode_.outcome = Episode::Outcome::success;
        if (last.violated()) episode_.outcome = Episode::Outcome::failure;
        const std::uint64_t seen = fulfilled_.value_or(row_);
        episode_.succeeds = std::min(seen > 0 ? seen - 1 : 0, row_ - 1);
    }

    const Watched& watched_;
    const plan::Plan& plan_;
    episodes::Follower follower_;
    std::vector<std::size_t> let_at_;  ///< per let of the model, its place in the evaluator
    Episode episode_;
    std::uint64_t row_ = 0;
    std::optional<std::uint64_t> fulfilled_;
    float share_ = 0;
    std::optional<float> first_;  ///< the robustness of the next phase where this one began
};

/// Returns the progress before each phase, and 1.
std::vector<double> steps_of(const Judged& judged) {
    const std::size_t phases = judged.phases.size();
    std::vector<double> shares(phases);
    for (const auto& [index, episode] : judged.episodes) {
        if (episode.reached.size() < phases || episode.reached.back() == 0) continue;
        const auto all = static_cast<double>(episode.reached.back());
        for (std::size_t k = 0; k < phases; ++k)
            shares[k] +=
                static_cast<double>(episode.reached[k] - (k > 0 ? episode.reached[k - 1] : 0)) /
                all;
    }
    double sum = 0;
    for (const double share : shares) sum += share;
    std::vector<double> steps = {0};
    for (const double share : shares)
        steps.push_back(steps.back() + (sum > 0 ? share / sum : 1 / static_cast<double>(phases)));
    steps.back() = 1;
    return steps;
}

}  // namespace

float Judged::progress(const Place& place) const {
    const double begin = steps[place.phase];
    if (place.phase + 1 >= steps.size()) return 1;
    return static_cast<float>(begin + place.share * (steps[place.phase + 1] - begin));
}

std::string samples_of(const std::string& episode, const std::string& made) {
    const auto of = data::dataset_path(episode);
    if (made.empty() || !of) return episode;
    return fmt::format("{}/{}-{:06}.npz", made, recordings::name_of_folder(of->folder), of->first);
}

std::optional<Judged> judge(const Compiled& compiled, const CompileOptions& options,
                            const Wanted& wanted, const std::vector<std::string>& paths,
                            const std::string& made, const recordings::NamesInFile& names,
                            diag::Sink& sink) {
    const Watched watched(*compiled.model, wanted, sink);
    if (!watched.ok) return std::nullopt;
    const auto with_lets = compile(watched.model, options, sink);
    if (!with_lets) return std::nullopt;
    Judged judged;
    judged.phases = watched.phase_texts;
    Reader reader(watched, with_lets->plan);
    for (const std::string& path : paths) {
        const auto found = recordings::find_episode(path);
        if (!found) {
            sink.report(recordings::in_trace(found.failure(), path));
            return std::nullopt;
        }
        const std::string from = samples_of(path, made);
        auto episode = reader.read(from, found->episode->length, names);
        if (!episode) {
            sink.report(recordings::in_trace(episode.failure(), from));
            return std::nullopt;
        }
        judged.episodes[found->episode->index] = std::move(*episode);
    }
    if (!judged.phases.empty()) judged.steps = steps_of(judged);
    return judged;
}

}  // namespace etlc::annotate
