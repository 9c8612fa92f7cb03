#include "check/encoders/encoders.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <set>
#include <vector>

#include "artifacts/json.hpp"
#include "check/context/context.hpp"
#include "check/numbers/decimal.hpp"
#include "data/files/file.hpp"
#include "data/files/hash.hpp"
#include "data/text/text.hpp"

namespace etlc::check {

namespace {

using artifacts::Json;
using diag::Code;
using diag::Failure;

constexpr std::uint64_t kMaxExtent = 1U << 14U;  ///< of an image, rows or columns
constexpr std::uint64_t kMaxSettingsBytes = 1U << 20U;
constexpr std::uint64_t kMaxSettingsValues = 1000;

struct Key {
    std::string_view key;
    std::string Encoder::*word;  ///< null: it takes no word
    std::string_view words;      ///< those that it takes; empty: any
    std::vector<float> Encoder::*numbers;
    std::size_t least;  ///< count of numbers
    std::size_t most;
    std::string_view expected;
};

constexpr Key kSettings[] = {
    {"image", nullptr, "", &Encoder::image, 2, 2,
     "its rows and columns, whole numbers from 1 to 16384"},
    {"mean", nullptr, "", &Encoder::mean, 3, 3, "a number each for red, green and blue"},
    {"deviation", nullptr, "", &Encoder::deviation, 3, 3,
     "a positive number each for red, green and blue"},
    {"resize", &Encoder::filter, "bilinear bicubic", &Encoder::resize, 0, 2,
     "bilinear or bicubic, and the length of the shorter side, or rows and columns, or nothing for "
     "the size of 'image': whole numbers from 1 to 16384, as in resize bicubic [256]"},
    {"flip", &Encoder::flip, "horizontal vertical both", nullptr, 0, 0,
     "horizontal, vertical or both"},
    {"channels", &Encoder::channels, "rgb bgr", nullptr, 0, 0, "rgb or bgr"},
    {"margins", &Encoder::margins, "even down", nullptr, 0, 0, "even or down"},
    {"output", &Encoder::output, "", nullptr, 0, 0, "the name of an output, in quotes"},
    {"pool", &Encoder::pool, "cls mean", nullptr, 0, 0, "cls or mean"}};

bool fits(const Key& setting, const std::string& number, float& value) {
    if (to_float(number, value) != Fit::fits) return false;
    if (setting.numbers == &Encoder::image || setting.numbers == &Encoder::resize) {
        const auto extent = Decimal::parse(number).whole(kMaxExtent);
        return extent && *extent > 0;
    }
    return setting.key == "mean" || Decimal::parse(number).is_positive();
}

bool fits(const Key& setting, const std::string& word) {
    if (setting.word == nullptr) return word.empty();
    const auto known = fmt::format(" {} ", setting.words);
    if (setting.words.empty()) return !word.empty();
    return !word.empty() && known.find(fmt::format(" {} ", word)) != std::string::npos;
}

/// Returns "bicubic [256]", "[224, 224]" or "both".
template <class Number>
std::string text_of(const std::string& word, const std::vector<Number>& numbers) {
    if (numbers.empty() && !word.empty()) return word;
    return fmt::format("{}{}[{}]", word, word.empty() ? "" : " ", fmt::join(numbers, ", "));
}

std::string known_keys() {
    std::vector<std::string> keys;
    for (const Key& setting : kSettings) keys.push_back(data::in_quotes(setting.key));
    return diag::alternatives(keys);
}

Failure wrong(const std::string& message) {
    return {Code::encoder_form, message};
}

/// Takes "both", [224, 224] or ["bicubic", 256].
std::optional<Failure> take(Encoder& encoder, const std::string& key, const Json& value) {
    std::string word;
    std::vector<std::string> numbers;
    const auto add = [&](const Json& item) {
        const bool is_word = item.kind == Json::Kind::string && word.empty() && numbers.empty();
        if (is_word) word = item.text;
        if (item.kind == Json::Kind::number) numbers.push_back(item.text);
        return is_word || item.kind == Json::Kind::number;
    };
    const bool good = value.kind == Json::Kind::array
                          ? std::all_of(value.items.begin(), value.items.end(), add)
                          : value.kind == Json::Kind::string && add(value);
    if (!good)
        return wrong(
            fmt::format("{} is {}, expected an array of numbers, or a word before them, "
                        "as in [\"bicubic\", 256]",
                        data::in_quotes(key), describe(value)));
    const auto mistake = set_setting(encoder, key, word, numbers);
    return mistake ? std::optional(wrong(*mistake)) : std::nullopt;
}

bool takes_file(Context& c, const ast::Load& load) {
    if (load.key.empty()) return true;
    return c.refuse(Code::encoder_form, load.key_span,
                    "this is a separate file; expected load(\"FILE\") without a key");
}

bool set_settings(Context& c, const ast::Encoder& declaration, Encoder& encoder) {
    std::set<std::string> given;
    for (const ast::Encoder::Setting& setting : declaration.settings) {
        if (setting.file) {
            if (!given.insert(setting.key.text).second)
                return c.refuse(Code::encoder_form, setting.span, "preprocessor is given twice");
            if (!takes_file(c, *setting.file)) return false;
            encoder.preprocessor = setting.file->path;
            continue;
        }
        std::vector<std::string> numbers;
        for (const ast::Number& number : setting.values) numbers.push_back(number.text);
        const auto mistake =
            given.insert(setting.key.text).second
                ? set_setting(encoder, setting.key.text, setting.word ? setting.word->text : "",
                              numbers)
                : std::optional(fmt::format("{} is given twice", setting.key.text));
        if (!mistake) continue;
        return c.refuse(Code::encoder_form, setting.span, *mistake);
    }
    return true;
}

}  // namespace

std::optional<std::string> set_setting(Encoder& encoder, const std::string& key,
                                       const std::string& word,
                                       const std::vector<std::string>& numbers) {
    const auto* const setting = std::find_if(std::begin(kSettings), std::end(kSettings),
                                             [&](const Key& s) { return s.key == key; });
    if (setting == std::end(kSettings))
        return fmt::format("there is no setting {}; expected {}", data::in_quotes(key),
                           known_keys());
    std::vector<float> values;
    bool good =
        fits(*setting, word) && numbers.size() >= setting->least && numbers.size() <= setting->most;
    for (const std::string& number : numbers)
        good = good && fits(*setting, number, values.emplace_back());
    if (!good)
        return fmt::format("{} {}; expected {}", key, text_of(word, numbers), setting->expected);
    const std::string word_before = setting->word == nullptr ? "" : encoder.*setting->word;
    const std::vector<float> before =
        setting->numbers == nullptr ? std::vector<float>() : encoder.*setting->numbers;
    const bool is_given = !word_before.empty() || !before.empty();
    if (is_given && (word_before != word || before != values))
        return fmt::format("{} is {} in the spec and {} here; give it once", key,
                           text_of(word_before, before), text_of(word, values));
    if (setting->word != nullptr) encoder.*setting->word = word;
    if (setting->numbers != nullptr) encoder.*setting->numbers = std::move(values);
    return std::nullopt;
}

std::string settings_text(const Encoder& encoder) {
    std::string text;
    const auto add = [&](std::string_view key, const std::string& word,
                         const std::vector<float>& numbers) {
        if (word.empty() && numbers.empty()) return;
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", key, text_of(word, numbers));
    };
    const auto three = [](const std::vector<float>& values, float usual) {
        return values.empty() ? std::vector<float>(3, usual) : values;
    };
    // A setting that changes nothing has no text: the fingerprint is that of an encoder without it.
    add("flip", encoder.flip, {});
    add("resize", encoder.filter, encoder.resize);
    add("image", "", encoder.image);
    add("channels", encoder.channels == "rgb" ? "" : encoder.channels, {});
    add("margins", encoder.margins == "even" ? "" : encoder.margins, {});
    add("mean", "", three(encoder.mean, 0));
    add("deviation", "", three(encoder.deviation, 1));
    add("output", encoder.output.empty() ? "" : fmt::format("\"{}\"", encoder.output), {});
    add("pool", encoder.pool, {});
    return text;
}

std::string settings_path(const std::string& model_path) {
    return std::filesystem::path(model_path).replace_extension(".json").string();
}

diag::Result<Json> read_settings(const std::string& path) {
    const auto text = data::read_file(path, kMaxSettingsBytes, Code::encoder_form);
    if (!text) return text.failure();
    return artifacts::parse_json(*text, kMaxSettingsValues, Code::encoder_form);
}

std::optional<Failure> take_settings_file(Encoder& encoder, const std::string& model_path) {
    const std::string path = settings_path(model_path);
    std::error_code error;
    if (path == model_path || !std::filesystem::exists(path, error)) return std::nullopt;
    const auto root = read_settings(path);
    if (!root) return root.failure();
    if (root->kind != Json::Kind::object)
        return wrong(fmt::format("the file is {}, expected an object with {}", describe(*root),
                                 known_keys()));
    for (std::size_t i = 0; i < root->keys.size(); ++i)
        if (auto failure = take(encoder, root->keys[i], root->items[i])) return failure;
    return std::nullopt;
}

diag::Result<embedded::Encoder> describe(Encoder& encoder, const std::string& spec_path,
                                         std::string& place) {
    const std::string model_path = place = data::beside(spec_path, encoder.model);
    auto hash = data::hash_of_file(model_path, Code::encoder_refused);
    if (!hash) return hash.failure();
    place = settings_path(model_path);
    if (auto failure = take_settings_file(encoder, model_path)) return *failure;
    if (!encoder.preprocessor.empty()) {
        place = data::beside(spec_path, encoder.preprocessor);
        if (auto failure = take_preprocessor(encoder, place)) return *failure;
    }
    return embedded::Encoder{encoder.declaration, std::move(*hash), settings_text(encoder), "", 0};
}

void check_encoders(Context& c) {
    for_each_declaration<ast::Encoder>(c.spec, [&](const ast::Encoder& declaration, Index index) {
        Encoder encoder;
        encoder.name = declaration.name.text;
        encoder.model = declaration.model.path;
        encoder.span = declaration.name.span;
        const bool good = set_settings(c, declaration, encoder);
        if (!takes_file(c, declaration.model) || !good)
            c.scope.entity(NameKind::encoder, index).broken = true;
        encoder.declaration =
            fmt::format("load(\"{}\"), {}", encoder.model, settings_text(encoder));
        if (!encoder.preprocessor.empty())
            encoder.declaration += fmt::format(", preprocessor load(\"{}\")", encoder.preprocessor);
        c.model.encoders.push_back(std::move(encoder));
    });
}

std::optional<diag::Failure> other_encoder(const Model& model, const Input& input,
                                           const std::string& array, const embedded::Marks& marks) {
    if (input.encoder == kNone) return std::nullopt;
    const Encoder& encoder = model.encoders[input.encoder];
    const auto mark = marks.find(array);
    const bool is_known = mark != marks.end() && !encoder.fingerprint.empty();
    if (!is_known || mark->second == encoder.fingerprint) return std::nullopt;
    const auto same_model = encoder.otherwise.find(mark->second);
    const std::string run_by = same_model == encoder.otherwise.end()
                                   ? ""
                                   : fmt::format(", the same model run by {}", same_model->second);
    return diag::Failure{
        diag::Code::other_encoder,
        fmt::format("'{}' was made by encoder {}{}; expected {}, which is '{}' in the spec",
                    input.name, mark->second, run_by, encoder.fingerprint, encoder.name)};
}

bool is_unmarked(const Input& input, const std::string& array, const embedded::Marks& marks) {
    return input.encoder != kNone && !marks.contains(array);
}

void explain_unmarked(diag::Diagnostic& warning) {
    warning.note("embeddings by another encoder would be accepted too");
    warning.note(
        "`etlc embed` records the encoder in embedded.json, a member of the .npz file that "
        "numpy.savez does not write: copy it as shown in docs/recordings.md under Fingerprints; "
        "other kinds of recordings cannot record it");
}

namespace {

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
