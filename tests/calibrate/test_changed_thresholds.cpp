// Tests a thresholds file with one change: either it is refused, or the accepted contents are the
// same.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "check/check.hpp"
#include "check/guarantees/guarantees.hpp"
#include "parse/parse.hpp"
#include "random.hpp"
#include "roads.hpp"

namespace etlc::tests {
namespace {

using Json = nlohmann::ordered_json;

const std::string kTwoPredicates =
    "spec t; input x, y : f32; input z : f32[1] hold 1; target g = [[0]]; target h = [[3], [5]];\n"
    "predicate a = x <= calibrated(conformal, alpha = 0.2); truth a = y > 0.5;\n"
    "predicate b = min l2(z, g) < calibrated(conformal, alpha = 0.3); truth b = min l2(z, h) > "
    "2.5;\n"
    "predicate c = x > calibrated(conformal, alpha = 0.25); truth c = y <= 0.5;\n"
    "predicate d = min l2(z, g) - x <= calibrated(class_conditional, alpha = 0.2); truth d = y > "
    "0.5;\n"
    "predicate e = x >= calibrated(f1); truth e = y <= 0.5;\n"
    "predicate f = x < calibrated(adaptive, alpha = 0.2, gamma = 0.1, lo = -2, hi = 2); truth f = "
    "y > 0.5;\n"
    "monitor m = F (a && b); monitor n = G !c; monitor o = F (d && e && f);\n"
    "monitor u = F a calibrated(conformal, alpha = 0.2, against = missed_alarm);\n"
    "monitor v = F (e && b) calibrated(conformal, alpha = 0.3, against = missed_success);";

std::vector<std::string> two_predicate_episodes(Random& random, int count) {
    std::vector<std::string> episodes;
    for (int i = 0; i < count; ++i) {
        std::string text = "x,y,z[0]\n";
        for (int t = 0; t < 6; ++t) {
            const int y = random.between(0, 1);
            text += fmt::format("{},{},{}\n", 1 - y + 0.8 * (random.uniform() - 0.5), y,
                                random.uniform());
        }
        episodes.push_back(text);
    }
    return episodes;
}

/// Returns everything that is accepted from a file: the numbers that monitors compute with, and the
/// stated guarantees. Empty: refused. For the pooled methods, which have no guarantee for episodes,
/// it is the threshold.
std::string believed(const std::string& json) {
    const TemporaryPath path("thresholds.json", json);
    check::Options options;
    options.thresholds_path = path.path();
    diag::Sink sink;
    const source::File file("t.etl", kTwoPredicates);
    const auto model = check::check(parse::parse(file, sink), file, options, sink);
    if (!model) return "";
    std::string text;
    for (const check::Predicate& p : model->predicates) {
        const bool by_episode =
            p.threshold.origin == check::ThresholdOrigin::conformal || p.threshold.adaptation;
        text += fmt::format("{} {} {}", p.name, p.threshold.value, p.threshold.alpha);
        if (by_episode) text += fmt::format(" {} {}", p.threshold.k, p.threshold.n);
        if (p.threshold.adaptation) text += check::miss_bound(p);
        text += "\n";
    }
    for (const check::Monitor& monitor : model->monitors) {
        for (const check::Guarantee& guarantee : check::guarantees(*model, monitor))
            text += monitor.name + " " + check::text(guarantee) + "\n";
        if (!monitor.calibration) continue;
        const check::Threshold& shift = *monitor.calibration;
        text += fmt::format("{} {} {} {}\n", monitor.name, shift.value, shift.k, shift.n);
    }
    return text;
}

/// Visits every JSON value below this one, with its path.
void visit(Json& json, const std::string& path,
           const std::function<void(Json&, const std::string&)>& visitor) {
    visitor(json, path);
    if (!json.is_structured()) return;
    for (auto& [key, value] : json.items()) visit(value, path + "/" + key, visitor);
}

/// Changes of a value by a slip of the hand, by a merge, or on purpose.
std::vector<Json> changes(const Json& value) {
    std::vector<Json> all;
    if (value.is_number()) {
        const auto number = value.get<double>();
        for (const double other :
             {number + 1, number - 1, -number, 0.0, 1.0, number * 0.999, number * 1.001,
              std::nextafter(number, 1e9), std::nextafter(number, -1e9),
              static_cast<double>(std::nextafter(static_cast<float>(number), 1e9F)),
              static_cast<double>(std::nextafter(static_cast<float>(number), -1e9F))}) {
            all.push_back(other);
            if (other == std::floor(other) && std::abs(other) < 1e6)
                all.push_back(static_cast<int>(other));
        }
    } else if (value.is_string()) {
        const auto text = value.get<std::string>();
        for (const std::string other :
             {"", "array", "conformal", "f1", "class_conditional", "adaptive", "missed_alarm",
              "missed_success", "0123456789abcdef", "inf"})
            all.push_back(other);
        all.push_back(text + " ");
        all.push_back(text.substr(0, text.size() / 2));
    } else if (value.is_array()) {
        for (std::size_t i = 0; i < value.size(); ++i) {
            Json less = value;
            less.erase(i);
            all.push_back(less);
            Json more = value;
            more.push_back(value[i]);
            all.push_back(more);
            Json swapped = value;
            std::swap(swapped[i], swapped[value.size() - 1 - i]);
            all.push_back(swapped);
        }
        all.push_back(Json::array());
    } else if (value.is_object()) {
        for (const auto& [key, member] : value.items()) {
            Json less = value;
            less.erase(key);
            all.push_back(less);
            Json renamed = less;
            renamed[key + "s"] = member;
            all.push_back(renamed);
            for (const auto& [other, replacement] :
                 value.items()) {  // an entry pasted over another
                Json pasted = value;
                pasted[key] = replacement;
                if (other != key) all.push_back(pasted);
            }
        }
    }
    std::erase(all, value);
    return all;
}

TEST(ChangedThresholds, AreRefusedOrChangeNothing) {
    Random random(99);
    const Files first(two_predicate_episodes(random, 14));
    const Files second(two_predicate_episodes(random, 14));
    const Calibrated predicates = calibrated(kTwoPredicates, first.paths());
    ASSERT_FALSE(predicates.thresholds.empty()) << testing::PrintToString(predicates.codes);
    const Calibrated both = calibrated(kTwoPredicates, second.paths(), predicates.thresholds);
    ASSERT_FALSE(both.thresholds.empty()) << testing::PrintToString(both.codes);
    const std::string original = believed(both.thresholds);
    ASSERT_FALSE(original.empty());

    Json file = Json::parse(both.thresholds);
    ASSERT_EQ(believed(file.dump()), original);
    int refused = 0;
    int harmless = 0;
    visit(file, "", [&](Json& value, const std::string& path) {
        const Json before = value;
        for (const Json& change : changes(before)) {
            value = change;
            const std::string now = believed(file.dump());
            ++(now.empty() ? refused : harmless);
            EXPECT_TRUE(now.empty() || now == original)
                << path << ": " << before << " -> " << change << "\n"
                << now;
        }
        value = before;
    });
    EXPECT_GT(refused, 1000);
    EXPECT_GT(harmless, 50);  // the version, the order of episodes, a score that is not at the rank
}

/// Predicates calibrated again on the episodes of the monitors, with the entries merged by hand.
TEST(ChangedThresholds, MergedFilesWithAnEpisodeInBothAreRefused) {
    Random random(98);
    const Files first(two_predicate_episodes(random, 14));
    const Files second(two_predicate_episodes(random, 14));
    const Calibrated both = calibrated(kTwoPredicates, second.paths(),
                                       calibrated(kTwoPredicates, first.paths()).thresholds);
    Json merged = Json::parse(both.thresholds);
    ASSERT_FALSE(believed(merged.dump()).empty());
    merged["episodes"].push_back(merged["monitors"]["u"]["episodes"][3]);
    EXPECT_EQ(believed(merged.dump()), "");
}

}  // namespace
}  // namespace etlc::tests
