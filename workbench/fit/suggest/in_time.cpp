#include "fit/suggest/in_time.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <set>

#include "check/guarantees/provenance.hpp"
#include "diag/diag.hpp"
#include "fit/suggest/suggest.hpp"

namespace etlc::fit {

namespace {

using check::Index;
using check::Model;

/// Returns the durations to try, in steps, ascending.
std::vector<std::uint32_t> durations(const Model& model) {
    if (model.step_seconds <= 0) return {2, 5, 10, 20, 40};
    std::set<std::uint32_t> steps;
    for (const double seconds : {0.1, 0.2, 0.5, 1.0, 2.0})
        steps.insert(
            std::max(2U, static_cast<std::uint32_t>(std::lround(seconds / model.step_seconds))));
    return {steps.begin(), steps.end()};
}

/// The middle two of the durations, for formulas over two predicates, which are many.
std::vector<std::uint32_t> middle(const std::vector<std::uint32_t>& all) {
    if (all.size() <= 2) return all;
    return {all[all.size() / 2 - 1], all[all.size() / 2]};
}

struct Formula {
    std::string role;  ///< end of the let's name
    std::string text;
    std::uint32_t steps = 0;       ///< for which something has to hold; 0: for no time
    Index follows = check::kNone;  ///< the predicate that comes before
};

std::vector<Formula> over_one(const Model& model, const std::string& p) {
    std::vector<Formula> all;
    for (const std::uint32_t d : durations(model))
        all.push_back({"steady", fmt::format("held[{} steps] {}", d, p), d});
    for (const std::uint32_t d : durations(model))
        all.push_back({"recent", fmt::format("O[0, {} steps] {}", d, p)});
    return all;
}

std::vector<Formula> over_two(const Model& model, const std::string& p, Index other) {
    const std::string& q = model.predicates[other].name;
    std::vector<Formula> all;
    for (const std::uint32_t d : middle(durations(model)))
        for (const std::string& now : {p, "!" + q})
            all.push_back(
                {"after_" + q, fmt::format("{} && O held[{} steps] {}", now, d, q), d, other});
    all.push_back({"since_" + q, fmt::format("{} S {}", p, q), 0, other});
    return all;
}

bool is_part_of_word(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Replaces whole words.
std::string replaced(const std::string& text, const std::map<std::string, std::string>& words) {
    std::string result;
    for (std::size_t at = 0; at < text.size();) {
        std::size_t end = at;
        while (end < text.size() && is_part_of_word(text[end])) ++end;
        if (end == at) {
            result += text[at++];
            continue;
        }
        const std::string word = text.substr(at, end - at);
        const auto found = words.find(word);
        result += found == words.end() ? word : found->second;
        at = end;
    }
    return result;
}

std::string_view kind_of(const check::Monitor& monitor) {
    if (monitor.sliding) return "sliding monitor";
    constexpr std::array<std::string_view, 3> kKinds{"monitor", "restartable monitor",
                                                     "repeating monitor"};
    return kKinds[static_cast<std::size_t>(monitor.restarts)];
}

/// Replaces the monitors by blanks, so that places in the rest stay the same.
std::string without_monitors(const Model& model) {
    std::string text(model.file.text());
    for (const check::Monitor& monitor : model.monitors) {
        const std::size_t end = std::min(text.find(';', monitor.span.end - 1), text.size() - 1);
        for (std::size_t i = monitor.span.begin; i <= end; ++i)
            if (text[i] != '\n') text[i] = ' ';
    }
    return text;
}

class Building {
public:
    Building(const Model& model, const std::vector<Index>& asked)
        : model_(model),
          asked_(asked),
          words_(words_of(model.file.text())),
          taken_(words_),
          names_("", taken_) {}

    void add_predicate(Index predicate, const std::vector<Index>& labelled) {
        const std::string& p = model_.predicates[predicate].name;
        RankedInTime& ranking = result_.all.emplace_back();
        ranking.name = p;
        ranking.ranked.push_back({p, {}, p});
        for (const Formula& formula : over_one(model_, p)) add_let(ranking, predicate, formula);
        for (const Index other : labelled)
            if (other != predicate)
                for (const Formula& formula : over_two(model_, p, other))
                    add_let(ranking, predicate, formula);
    }

    void add_monitor(const check::Monitor& monitor) {
        const auto used = check::predicates_of(model_, monitor.formula);
        const bool is_tried = monitor.truth == check::kNone &&
                              check::lets_are_written_out(model_, monitor.formula) &&
                              std::any_of(asked_.begin(), asked_.end(), [&](Index predicate) {
                                  return std::binary_search(used.begin(), used.end(), predicate);
                              });
        if (!is_tried) return;
        RankedInTime ranking;
        ranking.name = monitor.name;
        ranking.of_monitor = true;
        add_trial(ranking, monitor, {});
        std::map<std::uint32_t, std::vector<const Let*>> steady;
        for (const Let& let : lets_) {
            if (!std::binary_search(used.begin(), used.end(), let.predicate)) continue;
            add_trial(ranking, monitor, {&let});
            if (let.is_steady()) steady[let.formula.steps].push_back(&let);
        }
        for (const auto& [steps, lets] : steady)
            if (lets.size() > 1) add_trial(ranking, monitor, lets);
        for (const Let& let : lets_) {
            if (!std::binary_search(used.begin(), used.end(), let.predicate)) continue;
            for (const Let* before : steady[let.formula.steps])
                if (before->predicate == let.formula.follows)
                    add_trial(ranking, monitor, {before, &let});
        }
        result_.all.push_back(std::move(ranking));
    }

    TimeTrials take() && {
        result_.text = fmt::format("{}\n{}\n", without_monitors(model_), fmt::join(lines_, "\n"));
        return std::move(result_);
    }

private:
    /// A candidate let: `name` in the trial, `pasted` in the lines to paste.
    struct Let {
        Index predicate;
        Formula formula;
        std::string name, pasted;

        bool is_steady() const { return formula.steps > 0 && formula.follows == check::kNone; }
    };

    void add_let(RankedInTime& ranking, Index predicate, const Formula& formula) {
        const std::string& p = ranking.name;
        std::set<std::string> taken = words_;
        Let let{predicate, formula, names_.unused(p + "_trial"),
                Declarations("", taken).unused(fmt::format("{}_{}", p, formula.role))};
        declare(lines_, let.name, let);
        ranking.ranked.push_back({formula.text, {}, let.name});
        declare(ranking.ranked.back().lines, let.pasted, let);
        lets_.push_back(std::move(let));
    }

    void declare(std::vector<std::string>& lines, const std::string& name, const Let& let) const {
        lines.push_back(fmt::format("let {} = {};", name, let.formula.text));
        lines.push_back(fmt::format("truth {} = {};", name, model_.predicates[let.predicate].name));
    }

    void add_trial(RankedInTime& ranking, const check::Monitor& monitor,
                   const std::vector<const Let*>& lets) {
        const std::string formula = check::print(model_, monitor.formula);
        std::map<std::string, std::string> trial;
        std::map<std::string, std::string> pasted;
        InTime candidate;
        std::vector<std::string> what;
        for (const Let* let : lets) {
            const std::string& p = model_.predicates[let->predicate].name;
            trial[p] = let->name;
            pasted[p] = let->pasted;
            what.push_back(fmt::format("{}: {}", p, let->formula.text));
            declare(candidate.lines, let->pasted, *let);
        }
        candidate.formula = lets.empty() ? formula : fmt::format("{}", fmt::join(what, ", "));
        candidate.trial = names_.unused(monitor.name + "_trial");
        const auto line = [&](const std::string& name, const auto& words) {
            return fmt::format("{} {} = {};", kind_of(monitor), name, replaced(formula, words));
        };
        if (!lets.empty()) candidate.lines.push_back(line(monitor.name, pasted));
        lines_.push_back(line(candidate.trial, trial));
        ranking.ranked.push_back(std::move(candidate));
    }

    const Model& model_;
    const std::vector<Index>& asked_;
    const std::set<std::string> words_;  ///< words of the spec
    std::set<std::string> taken_;        ///< with the names declared since
    Declarations names_;
    std::vector<Let> lets_;
    std::vector<std::string> lines_;
    TimeTrials result_;
};

}  // namespace

TimeTrials time_trials(const Model& model, const std::vector<Index>& asked,
                       const std::vector<Index>& labelled) {
    Building building(model, asked);
    for (const Index predicate : asked) building.add_predicate(predicate, labelled);
    for (const check::Monitor& monitor : model.monitors) building.add_monitor(monitor);
    return std::move(building).take();
}

void rank(RankedInTime& all) {
    std::stable_sort(all.ranked.begin(), all.ranked.end(), [](const InTime& a, const InTime& b) {
        return a.score.value.value_or(-1) > b.score.value.value_or(-1);
    });
}

}  // namespace etlc::fit
