// A small SVG page: shapes are written as text in the order they are drawn.
// Takes: coordinates in pixels, y downwards. Gives: the text of an .svg file.
#pragma once

#include <fmt/core.h>

#include <string>
#include <string_view>
#include <vector>

namespace demo {

struct Pixel {
    double x;
    double y;
};

class Svg {
public:
    enum class Anchor { start, middle, end };

    Svg(double width, double height);

    /// `style` is the shape's attributes, "fill='#fff'".
    void rectangle(Pixel corner, double width, double height, std::string_view style);
    void line(Pixel from, Pixel to, std::string_view style);
    void circle(Pixel centre, double radius, std::string_view style);
    void path(const std::vector<Pixel>& points, std::string_view style);
    void polygon(const std::vector<Pixel>& points, std::string_view style);
    void text(Pixel at, std::string_view words, double size, std::string_view colour,
              Anchor anchor = Anchor::start, std::string_view style = "");
    /// A picture given as a data: address.
    void image(Pixel corner, double width, double height, std::string_view address);

    std::string finished() const { return page_ + "</svg>\n"; }

private:
    std::string page_;
};

}  // namespace demo
