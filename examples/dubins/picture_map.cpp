#include "picture_parts.hpp"
#include "png.hpp"

namespace demo {
namespace {

/// Maps metres to pixels, north up.
struct MapScale {
    Area area;

    double per_metre() const { return area.width / (2 * kHalfWidth); }
    Pixel at(Point p) const {
        return {area.left + (p.x + kHalfWidth) * per_metre(),
                area.top + (kHalfWidth - p.y) * per_metre()};
    }
};

void draw_region(Svg& page, const MapScale& scale, const Disc& disc, std::string_view name,
                 std::string_view colour) {
    page.circle(
        scale.at(disc.centre), disc.radius * scale.per_metre(),
        fmt::format("fill='{0}' fill-opacity='0.12' stroke='{0}' stroke-width='1.5'", colour));
    Pixel at = scale.at(disc.centre);
    at.y += 6;
    page.text(at, name, 17, colour, Svg::Anchor::middle, "font-weight='700' fill-opacity='0.55'");
}

/// The car as an arrow head along its heading.
void draw_car(Svg& page, const MapScale& scale, const Car& car, double size) {
    std::vector<Pixel> corners;
    for (const auto& [turn, reach] : {std::pair{0.0, 1.2}, {2.5, 1.0}, {kPi, 0.45}, {-2.5, 1.0}}) {
        const Pixel centre = scale.at(car.position);
        corners.push_back({centre.x + size * reach * std::cos(car.heading + turn),
                           centre.y - size * reach * std::sin(car.heading + turn)});
    }
    page.polygon(corners, fmt::format("fill='{}' stroke='#ffffff' stroke-width='1'", kInk));
}

}  // namespace

void draw_map(Svg& page, Area area, const Recording& recording) {
    const MapScale scale{area};
    page.rectangle({area.left, area.top}, area.width, area.height,
                   fmt::format("fill='#fbfcfd' stroke='{}' stroke-width='1.2'", kRule));
    draw_region(page, scale, kGoalA, "A", kColours[0]);
    draw_region(page, scale, kGoalB, "B", kColours[1]);
    draw_region(page, scale, kObstacleC, "C", kColours[2]);

    const std::vector<Car>& states = recording.episode.states;
    std::vector<Pixel> route;
    for (const Car& car : states) route.push_back(scale.at(car.position));
    page.path(route, fmt::format("stroke='{}' stroke-width='2' stroke-linejoin='round'", kInk));
    for (int shot = 0; shot < kShots; ++shot)
        draw_car(page, scale, states[shot_step(shot, states.size())], 8);
    for (int shot = 0; shot < kShots; ++shot) {
        // The number stands to the left of the car, seen along its heading.
        const Car& car = states[shot_step(shot, states.size())];
        const Pixel at = scale.at(car.position);
        const Pixel label{at.x - 15 * std::sin(car.heading), at.y - 15 * std::cos(car.heading) + 4};
        page.text(label, fmt::format("{}", shot + 1), 11, kInk, Svg::Anchor::middle,
                  "font-weight='700' stroke='#ffffff' stroke-width='3' paint-order='stroke'");
    }
}

void draw_camera_strip(Svg& page, Area area, const Recording& recording) {
    constexpr int kColumns = 3;
    constexpr double kGap = 10;
    constexpr double kCaption = 18;
    const double side = (area.width - (kColumns - 1) * kGap) / kColumns;
    for (int shot = 0; shot < kShots; ++shot) {
        const std::size_t step = shot_step(shot, recording.steps.size());
        const Pixel corner{area.left + shot % kColumns * (side + kGap),
                           area.top + shot / kColumns * (side + kCaption + kGap)};
        page.image(corner, side, side, png_address(photograph(recording.episode.states[step])));
        page.rectangle(corner, side, side, fmt::format("fill='none' stroke='{}'", kTruth));
        page.text({corner.x, corner.y + side + 13}, fmt::format("{}", shot + 1), 10.5, kInk,
                  Svg::Anchor::start, "font-weight='700'");
        page.text({corner.x + side, corner.y + side + 13},
                  fmt::format("{:.1f} s", static_cast<double>(step) * kTimeStep), 10.5, kGrey,
                  Svg::Anchor::end);
    }
}

}  // namespace demo
