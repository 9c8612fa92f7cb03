// Tests what a guarantee depends on, on the model itself: every field is changed in turn. Either
// the text of reads differs, or the field is listed as irrelevant, with the reason.
#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

#include "changing.hpp"
#include "check/check.hpp"
#include "check/guarantees/provenance.hpp"
#include "parse/parse.hpp"

namespace etlc::tests {
namespace {

/// Contains everything that a model may hold. `m` reads all of it, `p` everything its threshold
/// depends on.
const std::string kReadSpec =
    "spec t; rate 10 Hz;\n"
    "input z : f32[2] hold 1; input w : i8[2] scale 0.5; input x : f32 in [-9, 9]; input y : f32;\n"
    "input b : bool missing false; input c : bool; input u, v : f32;\n"
    "projection Q = [[1, 0], [0, 2]] offset [[1, 1]]; projection V = [[1, 0], [1, 2]];\n"
    "target g = [[0, 0], [1, 1]]; target h = [[1, 2]] of Q(z); target k = [[3, 1]];\n"
    "target fit = fitted(kmeans, k = 2, away = 1, of = Q(z), where = p && q);\n"
    "predicate p = min l2(Q(z), g) - kth(2) l1(w, g) <= calibrated(f1);\n"
    "truth p = (mahalanobis([[2, 0], [0, 1]])(z, k) < 3 || min(x, 2) * abs(y) > 0.5) && O[0, 2] "
    "c;\n"
    "predicate q = x@2 - 2 / max(y, 3 steps) != 0.5 missing false; predicate r = l2([x, y], k) < "
    "0.5;\n"
    "truth r = O[1, 3] (b && l2(Q(z), h) > 1); predicate s = l2(z, k) < u;\n"
    "let often = p && q; monitor m = F[0, 4] (often && r && s && X b) calibrated(conformal, alpha "
    "= 0.1,\n"
    "    against = missed_alarm); sliding monitor n = G[0, 2] p; monitor o = F u > v;";

check::Model model_of_everything() {
    diag::Sink sink;
    const source::File file("t.etl", kReadSpec);
    check::Options options;
    options.allow_uncalibrated = true;
    options.allow_uncalibrated_monitors = true;
    options.allow_unfitted = true;
    auto model = check::check(parse::parse(file, sink), file, options, sink);
    if (!model) throw std::runtime_error(std::string(sink.sorted().front().message));
    check::Encoder encoder;
    encoder.name = "dino";
    encoder.fingerprint = "0123456789abcdef";
    model->encoders = {encoder, encoder};
    model->encoders[1].name = "clip";
    model->inputs[0].encoder = 0;
    return *model;
}

/// Returns the texts of reads for the threshold of p, the shift of m, and `fit`.
std::vector<check::Reads> read(const check::Model& model) {
    return {check::reads(model, 0), check::reads(model, model.monitors[0]),
            check::reads(model, model.fitted[0])};
}

/// Fields that no score depends on.
const std::set<std::string> kUnread{
    // Part of the fingerprint.
    "Encoder.model", "Encoder.preprocessor", "Encoder.image", "Encoder.mean", "Encoder.deviation",
    "Encoder.filter", "Encoder.resize", "Encoder.flip", "Encoder.channels", "Encoder.margins",
    "Encoder.output", "Encoder.pool", "Encoder.declaration", "Encoder.dimension",
    "Encoder.otherwise",
    // Tells the robot whether it has the same encoder.
    "Encoder.references",
    // Part of the hash of the values, or their source.
    "Projection.matrix", "Projection.offset", "Projection.origin", "Projection.path",
    "Projection.fitted", "Target.values", "Target.origin", "Target.path", "Target.encoded",
    "Target.fitted", "Distance.weights_fitted", "Distance.weights_path",
    // Part of the text.
    "Point.kind", "Point.dimension", "Point.inner", "Point.steps", "Point.parts", "Point.factors",
    "Past.kind", "Past.steps", "Expr.number", "Expr.number32", "Predicate.inputs",
    "Threshold.value64",
    // Ranges follow from the expression, the inputs and the threshold.
    "Past.range", "Predicate.delta", "Predicate.robustness",
    // The entry itself records the quality of the threshold.
    "Threshold.alpha", "Threshold.n", "Threshold.k", "Threshold.by_group", "Threshold.adaptation",
    "Monitor.calibration",
    // Derived.
    "Fitted.name", "Fitted.declaration", "Fitted.index", "Fitted.filled",
    // Names of formulas, which short ones are written without, and texts for people.
    "Let.name", "Let.formula", "Let.telemetry", "Let.truth", "Model.constants", "Model.rounded",
    "Model.rounding",
    // Unrelated.
    "Projection.space", "Model.name", "Model.retargetable", "Model.encoded", "Model.dependencies",
    "Model.reservations"};

TEST(Reads, EveryFieldOfTheModelCountsOrIsListed) {
    check::Model model = model_of_everything();
    const std::vector<check::Reads> before = read(model);
    Changing changing([&] { return read(model) != before; });
    visit(model, changing);
    EXPECT_EQ(read(model), before);
    EXPECT_GT(changing.all.size(), 100U);
    for (const std::string& field : changing.all) {
        const bool unread = kUnread.contains(field) || field.ends_with(".span");
        EXPECT_NE(changing.read.contains(field), unread) << field;
    }
    for (const std::string& field : kUnread) EXPECT_TRUE(changing.all.contains(field)) << field;
}

/// The monitor reads every input, distance and predicate.
TEST(Reads, EachThingOfAMonitorCounts) {
    check::Model model = model_of_everything();
    const check::Reads before = check::reads(model, model.monitors[0]);
    Changing changing([&] { return check::reads(model, model.monitors[0]) != before; });
    for (check::Input& input : model.inputs) {
        visit(model, input, changing);
        EXPECT_EQ(changing.some(), input.name != "v") << input.name;
    }
    for (check::Predicate& predicate : model.predicates) {
        const bool in_another = predicate.text.starts_with("u - v");
        visit(model, predicate, changing);
        EXPECT_NE(changing.some(), in_another) << predicate.shown();
    }
    for (check::Distance& distance : model.distances) {
        visit(model, distance, changing);
        EXPECT_TRUE(changing.some()) << distance.text;
    }
    for (check::Truth& truth : model.truths) {
        visit(model, truth, changing);
        EXPECT_TRUE(changing.some()) << truth.predicate;
    }
}

}  // namespace
}  // namespace etlc::tests
