// Tests whole chains: fit, calibrate, change the spec, compile. Either the changed spec is refused,
// or its guarantees hold for new episodes in simulation, and the same demonstrations give the same
// numbers for it. The test is a sample; ETLC_CHAINS=5000 in the environment tries that many chains.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>

#include "calibrate/shift.hpp"
#include "chains.hpp"
#include "check/guarantees/guarantees.hpp"
#include "check/guarantees/provenance.hpp"
#include "compile.hpp"
#include "episodes.hpp"
#include "episodes/recording.hpp"
#include "random.hpp"
#include "roads.hpp"

namespace etlc::tests {
namespace {

using check::Index;
using episodes::Label;

constexpr int kNew = 150;           ///< episodes per chain
constexpr double kNoChance = 1e-9;  ///< significance per figure; there are some hundred

Files files_of(const World& world, int count, Random& random) {
    Files files;
    for (int i = 0; i < count; ++i) files.add(episode_of(world, world.arrays, random));
    return files;
}

// ---- chance -------------------------------------------------------------------------------------

/// Returns P(at least m of n are missed), where the missed fraction is Beta(n + 1 - k, k) or less,
/// as for a threshold at rank k of n scores (Vovk, 2012).
double chance_of(int missed, int all, std::uint64_t n, std::uint64_t k) {
    const auto a = static_cast<double>(n + 1 - k);
    const auto b = static_cast<double>(k);
    double sum = 0;
    for (int m = missed; m <= all; ++m)
        sum += std::exp(std::lgamma(all + 1.0) - std::lgamma(m + 1.0) - std::lgamma(all - m + 1.0) +
                        std::lgamma(m + a) + std::lgamma(all - m + b) - std::lgamma(all + a + b) +
                        std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b));
    return std::min(1.0, sum);
}

/// Returns the probability of so small a product of p-values that are each uniform or larger
/// (Fisher): P(chi squared with 2 n degrees of freedom > -2 sum of logarithms).
double chance_of_all(const std::vector<double>& chances) {
    double half = 0;
    for (const double one : chances) half -= std::log(one);
    double sum = 0;
    for (std::size_t i = 0; i < chances.size(); ++i)
        sum += std::exp(-half + static_cast<double>(i) * std::log(std::max(half, 1e-300)) -
                        std::lgamma(static_cast<double>(i) + 1));
    return half == 0 ? 1.0 : std::min(1.0, sum);
}

// ---- the guarantees in simulation ---------------------------------------------------------------

struct Misses {
    int missed = 0;
    int all = 0;
};

template <class Step>
void replay(const episodes::Wanted& wanted, const std::string& episode,
            const std::vector<episodes::Follower*>& followers, Step step) {
    auto recording = episodes::Recording::open(wanted, csv_episode(episode));
    ASSERT_TRUE(recording) << recording.failure().message;
    for (episodes::Follower* follower : followers) follower->reset();
    const auto take = [&] {
        step(*recording);
        return true;
    };
    ASSERT_TRUE(episodes::replay(*recording, followers, take, take));
}

Index predicate_of(const check::Model& model) {
    for (Index p = 0; p < model.predicates.size(); ++p)
        if (model.predicates[p].name == "a") return p;
    return check::kNone;
}

/// Returns the steps around a change at which labels are unknown, per predicate.
std::vector<std::uint32_t> within_of(const check::Model& model, const check::Monitor* monitor) {
    std::vector<std::uint32_t> within;
    for (const check::Predicate& predicate : model.predicates)
        within.push_back(monitor != nullptr && monitor->calibration ? monitor->calibration->within
                                                                    : predicate.threshold.within);
    return within;
}

/// Counts frames of known distance that are called what they are not, per episode or each: positive
/// ones that are missed, or negative ones.
Misses misses_of_predicate(const check::Model& model, const std::vector<std::string>& fresh,
                           bool by_frame, bool positives = true) {
    const Index a = predicate_of(model);
    const check::Predicate& predicate = model.predicates[a];
    const plan::Plan plan = plan::measuring(model, {a});
    const episodes::Leaks leaks(model, {});
    episodes::Wanted wanted = episodes::wanted(model, {&plan}, {a}, leaks);
    wanted.within = within_of(model, nullptr);
    const check::Threshold& threshold = predicate.threshold;
    episodes::Follower measured(plan);
    Misses result;
    for (const std::string& episode : fresh) {
        int missed = 0;
        int positive = 0;
        replay(wanted, episode, {&measured}, [&](const episodes::Recording& recording) {
            const float delta = measured.evaluator().distance(a);
            if (recording.label(a) != (positives ? Label::yes : Label::no) || std::isnan(delta))
                return;
            ++positive;
            missed += check::holds(predicate.comparison, delta,
                                   positives ? threshold.value : threshold.low()) == positives
                          ? 0
                          : 1;
        });
        result.missed += by_frame ? missed : std::min(missed, 1);
        result.all += by_frame ? positive : 1;
    }
    return result;
}

/// Counts episodes in which some verdict of the monitor misses an alarm, or a success.
Misses misses_of_monitor(const check::Model& model, const std::vector<std::string>& fresh,
                         bool alarms) {
    std::vector<Index> labelled;
    for (const Index p : check::predicates_of(model, model.monitors[0].formula))
        if (!check::is_own_truth(model, p)) labelled.push_back(p);
    diag::Sink sink;
    const auto monitors = compile(model, {}, sink);
    const auto truth = episodes::ground_truth(calibrate::unshifted(model), labelled);
    const auto truths = compile(truth.model, {{}, check::Values::boolean}, sink);
    const episodes::Leaks leaks(model, {});
    episodes::Wanted wanted =
        episodes::wanted(model, {&monitors->plan, &truths->plan}, labelled, leaks);
    wanted.within = within_of(model, &model.monitors[0]);
    episodes::Follower says(monitors->plan);
    episodes::Follower is(truths->plan, &truth);
    Misses result;
    for (const std::string& episode : fresh) {
        bool missed = false;
        replay(wanted, episode, {&is, &says}, [&](const episodes::Recording&) {
            if (!is.reports(0)) return;
            missed |= alarms ? is.verdict(0).violated() && says.verdict(0).satisfied()
                             : is.verdict(0).satisfied() && says.verdict(0).violated();
        });
        result.missed += missed ? 1 : 0;
        ++result.all;
    }
    return result;
}

class Campaign {
public:
    void run(int chains) {
        for (int i = 0; i < chains; ++i) {
            seed_ = static_cast<std::uint64_t>(i);
            Random random(7000 + seed_);
            one(random);
            if (testing::Test::HasFatalFailure()) return;
        }
        for (const auto& [figure, chances] : chances_)
            EXPECT_GT(chance_of_all(chances), kNoChance) << figure << ", " << chances.size();
        fmt::print(
            "{} chains: {} could not be calibrated, {} were refused once changed, {} were "
            "accepted; {} figures held, of {} kinds\n",
            chains, void_, refused_, accepted_, figures_, chances_.size());
    }
    int refused() const { return refused_; }
    int accepted() const { return accepted_; }
    int figures() const { return figures_; }

private:
    struct Made {
        std::string fits;
        Calibrated calibrated;
    };

    /// Calibrates from the same demonstrations.
    static Made make(const Chain& chain, const std::string& spec, const std::vector<Files>& demos) {
        Made made;
        if (chain.has_fitted) made.fits = fitted(spec, demos[0].paths());
        if (chain.has_fitted && made.fits.empty()) return made;
        made.calibrated = calibrated(spec, demos[1].paths(), "", made.fits);
        if (chain.method == Method::whole_of_f1 && !made.calibrated.thresholds.empty())
            made.calibrated =
                calibrated(spec, demos[2].paths(), made.calibrated.thresholds, made.fits);
        return made;
    }

    void one(Random& random) {
        const Chain chain = random_chain(random);
        std::vector<Files> demos;
        for (const int count : {chain.has_fitted ? 12 : 0, random.between(25, 45),
                                chain.method == Method::whole_of_f1 ? 40 : 0})
            demos.push_back(files_of(chain.world, count, random));
        const Made made = make(chain, chain.spec, demos);
        const std::string& file = made.calibrated.thresholds;
        if (file.empty()) {  // an infinite score, too few episodes with a score, or no true frame
            ++void_;
            return;
        }
        const Checked same = checked(chain.spec, file, made.fits);
        ASSERT_TRUE(same.model) << seed_ << "\n" << chain.spec << same.text;
        const Edit edit = random_edit(chain.spec, random);
        std::string spec = chain.spec;
        if (!edit.from.empty()) spec.replace(spec.find(edit.from), edit.from.size(), edit.to);
        const Checked now = checked(spec, file, made.fits);
        if (!now.model) {
            ++refused_;
            return;
        }
        ++accepted_;
        if (spec != chain.spec) {
            const Made again = make(chain, spec, demos);
            // The file of fitted things names inputs that nothing fitted reads with `hold`.
            if (edit.from.find(" : f32") == std::string::npos) {
                EXPECT_EQ(again.fits, made.fits) << seed_ << edit.name() << "\n" << chain.spec;
            }
            EXPECT_EQ(numbers(again.calibrated.thresholds), numbers(file))
                << seed_ << edit.name() << "\n"
                << chain.spec;
        }
        judge(chain, edit, spec, *now.model, random);
    }

    void judge(const Chain& chain, const Edit& edit, const std::string& spec,
               const check::Model& model, Random& random) {
        // Labels are recorded if nothing else defines the truth.
        const bool stated_now = spec.find("truth a") != std::string::npos &&
                                chain.spec.find("truth a") == std::string::npos;
        std::vector<std::string> fresh;
        for (int i = 0; i < kNew; ++i)
            fresh.push_back(episode_of(chain.world, chain.world.arrays && !stated_now, random));
        const check::Threshold& threshold = model.predicates[predicate_of(model)].threshold;
        const bool by_frame = threshold.origin == check::ThresholdOrigin::class_conditional;
        if (by_frame || threshold.origin == check::ThresholdOrigin::conformal ||
            threshold.adaptation)
            for (const bool positives : {true, false})
                if (calibrate::is_against(threshold, positives))
                    note(by_frame    ? "frames"
                         : positives ? "predicate"
                                     : "false positives",
                         edit, spec, misses_of_predicate(model, fresh, by_frame, positives),
                         threshold, is_inner(threshold, positives));
        const check::Monitor& monitor = model.monitors[0];
        for (const check::Guarantee& guarantee : check::guarantees(model, monitor))
            judge(chain, edit, spec, model, guarantee, fresh);
    }

    /// Whether the inner one of two thresholds is against this error.
    static bool is_inner(const check::Threshold& threshold, bool misses) {
        return threshold.against == check::Against::both && !misses;
    }

    void judge(const Chain& chain, const Edit& edit, const std::string& spec,
               const check::Model& model, const check::Guarantee& guarantee,
               const std::vector<std::string>& fresh) {
        using Kind = check::Guarantee::Kind;
        const check::Monitor& monitor = model.monitors[0];
        const check::Threshold& threshold = monitor.calibration
                                                ? *monitor.calibration
                                                : model.predicates[predicate_of(model)].threshold;
        const bool of_both = threshold.against == check::Against::both;
        const bool alarms = guarantee.kind == Kind::missed_alarm ||
                            (guarantee.kind == Kind::satisfied_wrongly && monitor.calibration);
        const bool successes = guarantee.kind == Kind::missed_success ||
                               (guarantee.kind == Kind::violated_wrongly && monitor.calibration);
        // The guarantee on successes excludes missing samples.
        if (!guarantee.part.empty() || (!alarms && !successes)) return;
        const bool missing = chain.world.missing > 0 || chain.world.missing_truth > 0;
        if (!monitor.calibration && successes && missing) return;
        note(monitor.calibration ? "whole" : "monitor", edit, spec,
             misses_of_monitor(model, fresh, alarms), threshold, of_both && alarms);
    }

    void note(const std::string& of, const Edit& edit, const std::string& spec,
              const Misses& misses, const check::Threshold& threshold, bool of_inner = false) {
        const std::uint64_t n = of_inner ? threshold.inner_n : threshold.n;
        const std::uint64_t k = of_inner ? threshold.inner_k : threshold.k;
        if (k > n) {
            EXPECT_EQ(misses.missed, 0) << spec;  // an infinite threshold
            return;
        }
        ++figures_;
        const double chance = chance_of(misses.missed, misses.all, n, k);
        chances_[of + ": " + edit.name()].push_back(chance);
        chances_[of].push_back(chance);
        EXPECT_GT(chance, kNoChance)
            << seed_ << " " << of << ", " << edit.name() << ": " << misses.missed << " of "
            << misses.all << " are missed, by score " << k << " of " << n << "\n"
            << spec;
    }

    std::uint64_t seed_ = 0;
    int void_ = 0;
    int refused_ = 0;
    int accepted_ = 0;
    int figures_ = 0;
    std::map<std::string, std::vector<double>> chances_;  ///< by guarantee
};

/// Checks that the campaign can fail: a monitor keeps its shift although a missing sample now
/// counts as satisfied.
TEST(Chains, ABrokenPromiseIsNoticed) {
    World world;
    world.missing = 0.3;
    world.noise = 0.3;
    Random random(41);
    const Files demos = files_of(world, 200, random);
    const std::string spec =
        "spec t; input y : f32; input z : f32[2]; target g = [[1, 0]];\n"
        "predicate a = l2(z, g) <= 0.7 missing false; truth a = y > 0.5;\n"
        "monitor m = F[0, 2] a calibrated(conformal, alpha = 0.1, against = missed_alarm);";
    const Calibrated made = calibrated(spec, demos.paths());
    ASSERT_FALSE(made.thresholds.empty());
    std::vector<std::string> fresh;
    for (int i = 0; i < 300; ++i) fresh.push_back(episode_of(world, false, random));
    check::Model model = *checked(spec, made.thresholds).model;
    const check::Threshold shift = *model.monitors[0].calibration;
    const Misses before = misses_of_monitor(model, fresh, true);
    EXPECT_GT(chance_of(before.missed, before.all, shift.n, shift.k), 1e-3);
    model.predicates[predicate_of(model)].missing = true;
    const Misses after = misses_of_monitor(model, fresh, true);
    EXPECT_LT(chance_of(after.missed, after.all, shift.n, shift.k), kNoChance) << after.missed;
}

TEST(Chains, HoldWhatTheyPromiseOrAreRefused) {
    const char* asked = std::getenv("ETLC_CHAINS");
    const int chains = asked != nullptr ? std::atoi(asked) : 250;
    Campaign campaign;
    campaign.run(chains);
    EXPECT_GT(campaign.refused(), chains / 4);
    EXPECT_GT(campaign.accepted(), chains / 8);
    EXPECT_GT(campaign.figures(), chains / 8);
}

}  // namespace
}  // namespace etlc::tests
