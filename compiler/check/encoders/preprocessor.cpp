#include "check/encoders/preprocessor.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "artifacts/json.hpp"
#include "check/encoders/encoders.hpp"
#include "check/numbers/decimal.hpp"
#include "data/text/text.hpp"

namespace etlc::check {

namespace {

using artifacts::Json;
using diag::Code;
using diag::Failure;
using JsonKind = Json::Kind;

/// How a type of processor reads `size`, and whether it cuts out the centre.
struct Processor {
    std::string_view type;  ///< without "ImageProcessor" and "Fast"
    bool is_square;         ///< a single number means rows and columns, not the shorter side
    enum class Crop : std::uint8_t { never, usually, by_part } crop;
};
using Crop = Processor::Crop;

constexpr Processor kProcessors[] = {{"Bit", false, Crop::usually},
                                     {"Blip", true, Crop::never},
                                     {"CLIP", false, Crop::usually},
                                     {"ConvNext", false, Crop::by_part},
                                     {"DeiT", true, Crop::usually},
                                     {"MobileNetV1", false, Crop::usually},
                                     {"MobileNetV2", false, Crop::usually},
                                     {"Siglip", true, Crop::never},
                                     {"ViT", true, Crop::never}};

/// Keys that change no number: names, and the form of what the processor takes and gives.
constexpr std::string_view kIgnored[] = {"processor_class",   "do_convert_rgb",       "data_format",
                                         "input_data_format", "return_tensors",       "device",
                                         "disable_grouping",  "_valid_processor_keys"};

constexpr float kOneOf255 = 1.0F / 255;

/// Thrown for a file that is not understood.
struct Fault {
    std::string message;
};

template <class... Parts>
[[noreturn]] void refuse(fmt::format_string<Parts...> text, Parts&&... parts) {
    throw Fault{fmt::format(text, std::forward<Parts>(parts)...)};
}

/// Reads the keys of the file, and knows afterwards which were not read.
class Config {
public:
    explicit Config(const Json& root) : root_(root) {
        if (root.kind != JsonKind::object)
            refuse("the file is {}, expected the object of a preprocessor_config.json",
                   describe(root));
        known_.insert(known_.end(), std::begin(kIgnored), std::end(kIgnored));
    }

    /// Returns the value of a key; null where the file has none, or null.
    const Json* find(std::string_view key) {
        known_.push_back(key);
        const Json* const value = root_.find(std::string(key));
        return value == nullptr || value->kind == JsonKind::null ? nullptr : value;
    }
    const Json& at(std::string_view key) {
        const Json* const value = find(key);
        if (value == nullptr)
            refuse(
                "the file has no '{}', and what is done without depends on the version of "
                "transformers",
                key);
        return *value;
    }
    /// A step that the file leaves out is done as usual.
    bool is_done(std::string_view step, bool usual) {
        const Json* const value = find(step);
        if (value == nullptr) return usual;
        if (value->kind != JsonKind::boolean)
            refuse("'{}' is {}, expected true or false", step, describe(*value));
        return value->text == "true";
    }
    /// Refuses keys that nothing has read, except for steps that are not done.
    void finish() const {
        for (std::size_t i = 0; i < root_.keys.size(); ++i) {
            const std::string& key = root_.keys[i];
            const Json& value = root_.items[i];
            const bool is_off =
                value.kind == JsonKind::null || (value.kind == JsonKind::boolean &&
                                                 value.text == "false" && key.starts_with("do_"));
            if (!is_off && std::find(known_.begin(), known_.end(), key) == known_.end())
                refuse("{} may change what is done to an image, and is not known for this type",
                       data::in_quotes(key));
        }
    }

private:
    const Json& root_;
    std::vector<std::string_view> known_;
};

const Processor& processor_of(Config& config) {
    const Json* const older = config.find("feature_extractor_type");
    const Json* const newer = config.find("image_processor_type");
    const Json* const name = newer == nullptr ? older : newer;
    std::string type = name == nullptr || name->kind != JsonKind::string ? "" : name->text;
    for (const std::string_view ending : {"Fast", "ImageProcessor", "FeatureExtractor"})
        if (type.ends_with(ending)) type.resize(type.size() - ending.size());
    for (const Processor& processor : kProcessors)
        if (processor.type == type) return processor;
    std::vector<std::string_view> types;
    for (const Processor& processor : kProcessors) types.push_back(processor.type);
    refuse(
        "'image_processor_type' is {}; known are {}, each followed by ImageProcessor or "
        "ImageProcessorFast",
        name == nullptr ? "missing" : describe(*name), fmt::join(types, ", "));
}

double number(const std::string& text) {
    double value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

std::string extent(std::string_view key, const Json& value) {
    const bool is_number = value.kind == JsonKind::number;
    const auto pixels = is_number ? Decimal::parse(value.text).whole(1U << 14U) : std::nullopt;
    if (!pixels || *pixels == 0)
        refuse("'{}' is {}, expected a whole number from 1 to 16384", key, describe(value));
    return fmt::format("{}", *pixels);
}

/// Returns rows and columns, or the shorter side alone.
std::vector<std::string> size_of(Config& config, std::string_view key, bool is_square) {
    const Json& size = config.at(key);
    if (size.kind == JsonKind::number) {
        std::vector<std::string> sides(is_square ? 2 : 1, extent(key, size));
        return sides;
    }
    const Json* const height = size.find("height");
    const Json* const width = size.find("width");
    const Json* const shorter = size.find("shortest_edge");
    if (size.kind == JsonKind::object && size.keys.size() == 2 && height != nullptr &&
        width != nullptr)
        return {extent(key, *height), extent(key, *width)};
    if (size.kind == JsonKind::object && size.keys.size() == 1 && shorter != nullptr)
        return {extent(key, *shorter)};
    refuse(
        "'{}' is {}, expected a number, {{\"height\": H, \"width\": W}} or "
        "{{\"shortest_edge\": S}}",
        key,
        size.kind == JsonKind::object ? fmt::format("an object with {}", fmt::join(size.keys, ", "))
                                      : describe(size));
}

std::vector<std::string> colours(Config& config, std::string_view key) {
    const Json& value = config.at(key);
    std::vector<std::string> numbers;
    if (value.kind == JsonKind::array)
        for (const Json& item : value.items)
            if (item.kind == JsonKind::number) numbers.push_back(item.text);
    if (numbers.size() != 3 || value.items.size() != 3)
        refuse("'{}' is {}, expected three numbers", key, describe(value));
    return numbers;
}

class Taker {
public:
    Taker(Encoder& encoder, const Json& root) : encoder_(encoder), config_(root) {}

    void take() {
        const Processor& processor = processor_of(config_);
        if (!config_.is_done("do_resize", true)) refuse("'do_resize' is false, expected true");
        const bool is_square = config_.is_done("default_to_square", processor.is_square);
        std::vector<std::string> resized = size_of(config_, "size", is_square);
        std::vector<std::string> image = resized;
        if (processor.crop == Crop::by_part)
            crop_part(resized, image);
        else if (processor.crop == Crop::usually)
            crop_centre(image);
        if (image.size() != 2)
            refuse(
                "images of any length remain, since only the shorter side is resized and "
                "nothing is cut off; expected 'do_center_crop' to be true");
        set("resize", filter(), resized == image ? std::vector<std::string>{} : resized);
        set("image", "", image);
        if (resized != image && encoder_.margins.empty()) set("margins", "down", {});
        take_colours();
        config_.finish();
    }

private:
    void crop_centre(std::vector<std::string>& image) {
        if (config_.is_done("do_center_crop", true))
            image = size_of(config_, "crop_size", true);
        else
            config_.find("crop_size");
    }

    /// ConvNeXt: images of less than 384 pixels are part of a larger one; others are resized to a
    /// square.
    void crop_part(std::vector<std::string>& resized, std::vector<std::string>& image) {
        if (resized.size() != 1) refuse("'size' has two sides, expected the shorter");
        const double side = number(resized[0]);
        const Json& part = config_.at("crop_pct");
        const double of_side = part.kind == JsonKind::number ? number(part.text) : 0;
        if (!(of_side > 0 && of_side <= 1))
            refuse("'crop_pct' is {}, expected a number above 0, up to 1", describe(part));
        image.assign(2, resized[0]);
        if (side >= 384)
            resized = image;
        else
            resized = {fmt::format("{:.0f}", std::floor(side / of_side))};
    }

    std::string filter() {
        const Json& resample = config_.at("resample");
        if (resample.kind == JsonKind::number && resample.text == "2") return "bilinear";
        if (resample.kind == JsonKind::number && resample.text == "3") return "bicubic";
        refuse("'resample' is {}, expected 2 (bilinear) or 3 (bicubic)", describe(resample));
    }

    void take_colours() {
        if (!config_.is_done("do_rescale", true))
            refuse("'do_rescale' is false, expected true: x / 255");
        if (const Json* const factor = config_.find("rescale_factor")) {
            const bool is_number = factor->kind == JsonKind::number;
            if (!is_number || static_cast<float>(number(factor->text)) != kOneOf255)
                refuse("'rescale_factor' is {}, expected 1/255", describe(*factor));
        }
        if (!config_.is_done("do_normalize", true)) {
            config_.find("image_mean");
            config_.find("image_std");
            return;
        }
        set("mean", "", colours(config_, "image_mean"));
        set("deviation", "", colours(config_, "image_std"));
    }

    void set(const std::string& key, const std::string& word,
             const std::vector<std::string>& numbers) {
        if (const auto mistake = set_setting(encoder_, key, word, numbers)) throw Fault{*mistake};
    }

    Encoder& encoder_;
    Config config_;
};

}  // namespace

std::optional<Failure> take_preprocessor(Encoder& encoder, const std::string& path) {
    const auto root = read_settings(path);
    if (!root) return root.failure();
    try {
        Taker(encoder, *root).take();
    } catch (const Fault& fault) {
        return Failure{Code::encoder_form, fault.message};
    }
    return std::nullopt;
}

}  // namespace etlc::check
