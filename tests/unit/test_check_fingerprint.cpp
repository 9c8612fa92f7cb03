// Tests the hashes of a monitor's sources: they hash the bytes that docs/generated_code.md names.
#include <gtest/gtest.h>

#include <string>

#include "check/model/fingerprint.hpp"
#include "checking.hpp"
#include "data/files/hash.hpp"

namespace etlc::check {

namespace {

const std::string kSpec =
    "spec t; // drawn by hand\n"
    "input z : f32[2];\n"
    "target goal = [[1, 0.5], [0.5, 1]];\n"
    "target far = [[-1, 0.25]];\n"
    "predicate near = min l2(z, goal) <= 0.75;\n"
    "predicate away = mahalanobis([1, 4])(z, far) > 1e3;\n"
    "monitor m = G (near || min l2(z, goal) > 3) || F away;\n";

Fingerprint of(const std::string& text) {
    const Checked checked(text);
    EXPECT_TRUE(checked.model) << checked.diagnostics();
    return checked.model ? fingerprint(*checked.model) : Fingerprint{};
}

std::string changed(const std::string& from, const std::string& to) {
    std::string text = kSpec;
    return text.replace(text.find(from), from.size(), to);
}

TEST(Fingerprint, IsOfTheBytesThatTheReferenceNames) {
    const Checked checked(kSpec);
    ASSERT_TRUE(checked.model) << checked.diagnostics();
    const Fingerprint made_from = fingerprint(*checked.model);
    EXPECT_EQ(made_from.spec, data::xxh64(kSpec));
    const std::string data = "goal " + checked.model->targets[0].hash + "\nfar " +
                             checked.model->targets[1].hash + "\nmahalanobis([1, 4])(z, far) " +
                             weights_hash(checked.model->distances[1]) + "\n";
    EXPECT_EQ(checked.model->distances[1].text, "mahalanobis([1, 4])(z, far)");
    EXPECT_EQ(made_from.data, data::xxh64(data));
    EXPECT_EQ(made_from.thresholds, data::xxh64("near 0.75\naway 1000\n"));
}

TEST(Fingerprint, SaysWhatIsAnother) {
    const Fingerprint one = of(kSpec);
    const Fingerprint reworded = of(changed("by hand", "by rule"));
    EXPECT_NE(reworded.spec, one.spec);
    EXPECT_EQ(reworded.data, one.data);
    EXPECT_EQ(reworded.thresholds, one.thresholds);
    const Fingerprint moved = of(changed("0.5, 1]]", "0.5, 2]]"));
    EXPECT_NE(moved.data, one.data);
    EXPECT_EQ(moved.thresholds, one.thresholds);
    EXPECT_NE(of(changed("[1, 4]", "[1, 5]")).data, one.data);
    const Fingerprint stricter = of(changed("0.75", "0.74999999"));
    EXPECT_EQ(stricter.thresholds, one.thresholds) << "the same float32";
    EXPECT_NE(of(changed("0.75", "0.7499999")).thresholds, one.thresholds);
    EXPECT_EQ(of(changed("> 3", "> 4")).thresholds, one.thresholds) << "it stands in the spec";
}

TEST(Fingerprint, KnowsWhatWasSet) {
    const std::string text =
        "spec t; const n = 3 s; const limit = 0.25; rate 1 Hz; input x : f32;"
        "monitor m = G[0, n] x > limit;";
    Options options;
    options.settings = {{"limit", "0.5", ""}, {"n", "2", "min"}};
    const Checked set(text, options);
    ASSERT_TRUE(set.model) << set.diagnostics();
    EXPECT_EQ(fingerprint(*set.model).spec, data::xxh64(text + "--set n=2 min\n--set limit=0.5\n"));
    EXPECT_EQ(of(text).spec, data::xxh64(text));
}

TEST(Fingerprint, IsZeroOfNothing) {
    const Fingerprint made_from = of("spec t; input on : bool; monitor m = G on;");
    EXPECT_NE(made_from.spec, 0U);
    EXPECT_EQ(made_from.data, 0U);
    EXPECT_EQ(made_from.thresholds, 0U);
}

}  // namespace

}  // namespace etlc::check
