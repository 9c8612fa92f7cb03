#include "picture.hpp"

#include "picture_parts.hpp"

namespace demo {
namespace {

constexpr double kWidth = 1200;
constexpr double kHeight = 764;

void draw_key(Svg& page, Pixel at) {
    page.rectangle(at, 26, 9, fmt::format("fill='{}'", kColours[0]));
    page.text({at.x + 33, at.y + 9}, "what the monitor said", 11, kGrey);
    page.rectangle({at.x + 165, at.y + 3}, 26, 4, fmt::format("fill='{}'", kTruth));
    page.text({at.x + 198, at.y + 9}, "what was true", 11, kGrey);
}

}  // namespace

std::string picture(const Recording& recording, int number) {
    Svg page(kWidth, kHeight);
    page.text({32, 42}, fmt::format("Drive {}: {}", number, recording.episode.plan), 21, kInk,
              Svg::Anchor::start, "font-weight='700'");
    page.text({32, 62},
              "Cosine distance from the encoded camera image to the nearest target, and what "
              "dubins.etl makes of it",
              12.5, kGrey);
    draw_traces(page, {32, 96, 780, 0}, recording);
    draw_key(page, {124, kHeight - 26});
    draw_map(page, {834, 90, 334, 334}, recording);
    page.text({834, 452}, "what the camera saw", 11.5, kGrey);
    draw_camera_strip(page, {834, 462, 334, 0}, recording);
    return page.finished();
}

}  // namespace demo
