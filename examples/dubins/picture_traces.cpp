#include <algorithm>

#include "picture_parts.hpp"

namespace demo {
namespace {

constexpr double kLabelWidth = 92;
constexpr double kNoteWidth = 130;  // right of the charts: thresholds and formulas
constexpr double kChartHeight = 100;
constexpr double kBarHeight = 9;
constexpr double kTruthHeight = 4;

/// Maps steps to pixels along the time axis that all charts share.
struct TimeAxis {
    double left;
    double width;
    std::size_t steps;

    double at(double step) const { return left + width * step / static_cast<double>(steps); }
};

std::string filled(std::string_view colour, double opacity = 1) {
    return fmt::format("fill='{}' fill-opacity='{}'", colour, opacity);
}

/// Rectangles over the runs of steps where `on` holds.
template <class Test>
void draw_runs(Svg& page, const TimeAxis& axis, double top, double height, const std::string& style,
               Test on) {
    for (std::size_t i = 0; i < axis.steps; ++i) {
        if (!on(i)) continue;
        const std::size_t start = i;
        while (i < axis.steps && on(i)) ++i;
        const double from = axis.at(static_cast<double>(start));
        page.rectangle({from, top}, axis.at(static_cast<double>(i)) - from, height, style);
    }
}

void draw_chart(Svg& page, const TimeAxis& axis, double top, const Recording& recording,
                std::size_t predicate) {
    constexpr double kHighest = 1.6;  // of the distances shown
    const auto height = [&](double distance) {
        return top + kChartHeight * (1 - std::clamp(distance / kHighest, 0.0, 1.0));
    };
    const std::string_view colour = kColours[predicate];
    const auto threshold = static_cast<double>(kThresholds[predicate]);
    for (const double tick : {0.0, 0.5, 1.0, 1.5}) {
        page.line({axis.left, height(tick)}, {axis.left + axis.width, height(tick)},
                  fmt::format("stroke='{}'", kRule));
        page.text({axis.left - 8, height(tick) + 3.5}, fmt::format("{:.1f}", tick), 10, kGrey,
                  Svg::Anchor::end);
    }
    const std::string band = filled(colour, 0.10);
    draw_runs(page, axis, top, kChartHeight, band,
              [&](std::size_t i) { return recording.steps[i].seen[predicate]; });
    page.line({axis.left, height(threshold)}, {axis.left + axis.width, height(threshold)},
              fmt::format("stroke='{}' stroke-width='1.2' stroke-dasharray='5 4'", colour));
    std::vector<Pixel> curve;
    for (std::size_t i = 0; i < axis.steps; ++i) {
        const double distance = static_cast<double>(recording.steps[i].distances[predicate]);
        curve.push_back({axis.at(static_cast<double>(i) + 0.5), height(distance)});
    }
    page.path(curve, fmt::format("stroke='{}' stroke-width='2' stroke-linejoin='round'", colour));
    page.text({axis.left + axis.width + 8, height(threshold) + 3.5},
              fmt::format("threshold {:.3g}", threshold), 10.5, colour);
}

/// A bar for what was said and, close below it, a thinner grey one for what was true.
template <class Said, class True>
void draw_bars(Svg& page, const TimeAxis& axis, double top, std::string_view name,
               std::string_view colour, Said said, True is) {
    page.text({axis.left - 8, top + kBarHeight}, name, 11.5, kInk, Svg::Anchor::end,
              "font-weight='600'");
    page.rectangle({axis.left, top}, axis.width, kBarHeight, filled("#f2f4f7"));
    draw_runs(page, axis, top, kBarHeight, filled(colour), said);
    page.rectangle({axis.left, top + kBarHeight + 2}, axis.width, kTruthHeight, filled("#f2f4f7"));
    draw_runs(page, axis, top + kBarHeight + 2, kTruthHeight, filled(kTruth), is);
}

void draw_seconds(Svg& page, const TimeAxis& axis, double top) {
    const double seconds = static_cast<double>(axis.steps) * kTimeStep;
    for (int second = 0; second <= static_cast<int>(seconds + 1e-9); second += 2) {
        const double x = axis.at(second / kTimeStep);
        page.line({x, top}, {x, top + 4}, fmt::format("stroke='{}'", kGrey));
        page.text({x, top + 17}, fmt::format("{} s", second), 10.5, kGrey, Svg::Anchor::middle);
    }
}

/// Where the verdict became final: a white mark on its bar.
void draw_final(Svg& page, const TimeAxis& axis, double top, const Recording& recording,
                std::size_t monitor) {
    for (std::size_t i = 0; i < axis.steps; ++i) {
        if (!recording.steps[i].claims[monitor].final) continue;
        const double x = axis.at(static_cast<double>(i));
        page.line({x, top - 3}, {x, top + kBarHeight + 3},
                  fmt::format("stroke='{}' stroke-width='2'", kInk));
        page.text({x + 5, top - 3},
                  fmt::format("final at {:.2f} s", static_cast<double>(i) * kTimeStep), 9.5, kGrey);
        return;
    }
}

}  // namespace

void draw_traces(Svg& page, Area area, const Recording& recording) {
    const TimeAxis axis{area.left + kLabelWidth, area.width - kLabelWidth - kNoteWidth,
                        recording.steps.size()};
    constexpr std::string_view kNames[] = {"goal A", "goal B", "obstacle C"};
    constexpr std::string_view kFormulas[] = {"F at_a", "G !near_c", "F at_a && G !near_c",
                                              "F (at_a && F at_b)"};
    double top = area.top;
    for (std::size_t p = 0; p < kPredicates.size(); ++p) {
        page.text({axis.left, top + 2}, fmt::format("distance to {}", kNames[p]), 11.5, kGrey);
        draw_chart(page, axis, top + 10, recording, p);
        top += kChartHeight + 18;
        draw_bars(
            page, axis, top, kPredicates[p], kColours[p],
            [&](std::size_t i) { return recording.steps[i].seen[p]; },
            [&](std::size_t i) { return recording.steps[i].true_now[p]; });
        top += kBarHeight + kTruthHeight + 22;
    }
    top += 10;
    for (std::size_t m = 0; m < kMonitors.size(); ++m) {
        draw_bars(
            page, axis, top, kMonitors[m], "#52606d",
            [&](std::size_t i) { return recording.steps[i].claims[m].satisfied; },
            [&](std::size_t i) { return recording.steps[i].true_so_far[m]; });
        draw_final(page, axis, top, recording, m);
        page.text({axis.left + axis.width + 8, top + kBarHeight}, kFormulas[m], 10.5, kGrey);
        top += kBarHeight + kTruthHeight + 16;
    }
    draw_seconds(page, axis, top - 8);
}

}  // namespace demo
