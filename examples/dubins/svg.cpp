#include "svg.hpp"

namespace demo {
namespace {

std::string coordinates(const std::vector<Pixel>& points) {
    std::string text;
    for (const Pixel& p : points) text += fmt::format("{:.1f},{:.1f} ", p.x, p.y);
    return text;
}

std::string escaped(std::string_view words) {
    std::string text;
    for (const char c : words) {
        if (c == '&') {
            text += "&amp;";
        } else if (c == '<') {
            text += "&lt;";
        } else {
            text += c;
        }
    }
    return text;
}

}  // namespace

Svg::Svg(double width, double height) {
    page_ = fmt::format(
        "<svg xmlns='http://www.w3.org/2000/svg' width='{0}' height='{1}' viewBox='0 0 {0} {1}' "
        "font-family='Inter, \"Helvetica Neue\", Helvetica, Arial, \"DejaVu Sans\", sans-serif'>\n",
        width, height);
    rectangle({0, 0}, width, height, "fill='#ffffff'");
}

void Svg::rectangle(Pixel corner, double width, double height, std::string_view style) {
    page_ += fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' {}/>\n",
                         corner.x, corner.y, width, height, style);
}

void Svg::line(Pixel from, Pixel to, std::string_view style) {
    page_ += fmt::format("<line x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}' {}/>\n", from.x,
                         from.y, to.x, to.y, style);
}

void Svg::circle(Pixel centre, double radius, std::string_view style) {
    page_ += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='{:.1f}' {}/>\n", centre.x, centre.y,
                         radius, style);
}

void Svg::path(const std::vector<Pixel>& points, std::string_view style) {
    page_ += fmt::format("<polyline points='{}' fill='none' {}/>\n", coordinates(points), style);
}

void Svg::polygon(const std::vector<Pixel>& points, std::string_view style) {
    page_ += fmt::format("<polygon points='{}' {}/>\n", coordinates(points), style);
}

void Svg::text(Pixel at, std::string_view words, double size, std::string_view colour,
               Anchor anchor, std::string_view style) {
    const std::string_view anchors[] = {"start", "middle", "end"};
    page_ += fmt::format(
        "<text x='{:.1f}' y='{:.1f}' font-size='{}' fill='{}' text-anchor='{}' {}>{}</text>\n",
        at.x, at.y, size, colour, anchors[static_cast<int>(anchor)], style, escaped(words));
}

void Svg::image(Pixel corner, double width, double height, std::string_view address) {
    page_ += fmt::format(
        "<image x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' image-rendering='pixelated' "
        "href='{}'/>\n",
        corner.x, corner.y, width, height, address);
}

}  // namespace demo
