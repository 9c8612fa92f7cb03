// Encodes frames from standard input.

#include <unistd.h>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "embed/worker/network.hpp"
#include "embed/worker/worker.hpp"
#include "recordings/frames/protocol.hpp"

namespace etlc::embed::worker {

namespace {

using recordings::frames::kMaxExtent;
using recordings::frames::kMaxPixels;
using recordings::frames::kRefused;
using recordings::frames::kWrongCall;

std::string shape_of(const Value& value) {
    return value.shape ? shape_text(*value.shape) : "any shape";
}

std::string listed(const std::vector<Value>& values) {
    std::string text;
    for (const Value& value : values)
        text += (text.empty() ? "'" : ", '") + value.name + "' (" + shape_of(value) + ")";
    return text;
}

std::string described(const Value& value) {
    return "'" + value.name + "' of " + (value.is_float ? "" : "not float, ") + shape_of(value);
}

/// Leaves one output: the one of this name, or the only one.
void choose_output(Interface& model, const std::string& name) {
    const auto chosen =
        std::find_if(model.outputs.begin(), model.outputs.end(),
                     [&](const Value& output) { return name.empty() || output.name == name; });
    if (chosen == model.outputs.end())
        refuse(kRefused, "gives no output '" + name + "', only " + listed(model.outputs));
    if (name.empty() && model.outputs.size() > 1)
        refuse(kRefused, "gives " + std::to_string(model.outputs.size()) +
                             " outputs, expected one embedding: " + listed(model.outputs) +
                             "; say which in the spec, as output \"" + chosen->name + "\"");
    model.outputs = {Value(*chosen)};
}

/// Checks that a model maps one image to numbers.
void check_interface(const Interface& model) {
    if (model.inputs.size() != 1)
        refuse(kRefused, "takes " + std::to_string(model.inputs.size()) +
                             " inputs, expected one image: " + listed(model.inputs));
    const Value& input = model.inputs[0];
    const Extents shape = input.shape.value_or(Extents{});
    const bool is_image = input.is_float && shape.size() == 4 && shape[0] <= 1 &&
                          (shape[1] == kChannels || shape[1] == 0);
    if (!is_image)
        refuse(kRefused, "takes " + described(input) +
                             ", expected float 1 x 3 x rows x columns, an image at a time");
    if (!model.outputs[0].is_float)
        refuse(kRefused, "gives " + described(model.outputs[0]) + ", expected float");
    if (!model.file_beside.empty())
        refuse(kRefused, "keeps weights in another file, '" + model.file_beside +
                             "', of which its fingerprint would know nothing: export it as one "
                             "file, as torch.onnx.export(..., external_data=False) does");
}

/// Takes --filter, --resize, --flip, --channels and --margins.
void take_transform(const Words& options, Settings& settings) {
    const std::string filter = options.text("--filter", "");
    const std::string flip = options.text("--flip", "");
    if (!filter.empty()) settings.filter = filter == "bicubic" ? Filter::bicubic : Filter::bilinear;
    const std::vector<double> sides =
        options.numbers("--resize", {double(settings.height), double(settings.width)});
    if (sides.size() == 1) settings.shorter = static_cast<int>(sides[0]);
    settings.resized_height = static_cast<int>(sides.front());
    settings.resized_width = static_cast<int>(sides.back());
    settings.mirrored = flip == "horizontal" || flip == "both";
    settings.upside_down = flip == "vertical" || flip == "both";
    settings.blue_first = options.text("--channels", "rgb") == "bgr";
    settings.margins_down = options.text("--margins", "even") == "down";
}

Settings settings_of(const Words& options, const Value& input) {
    Settings settings;
    const std::vector<double> image = options.numbers("--image");
    const std::vector<double> mean = options.numbers("--mean", {0, 0, 0});
    const std::vector<double> deviation = options.numbers("--deviation", {1, 1, 1});
    if (mean.size() != kChannels || deviation.size() != kChannels ||
        (!image.empty() && image.size() != 2))
        refuse(kWrongCall, "--image takes two numbers, --mean and --deviation three");
    const std::int64_t own[] = {input.shape->at(2), input.shape->at(3)};
    if (image.empty() && (own[0] == 0 || own[1] == 0))
        refuse(kRefused, "takes images of any size (" + shape_of(input) +
                             "): say which in the spec, as image [224, 224]");
    settings.height = image.empty() ? static_cast<int>(own[0]) : static_cast<int>(image[0]);
    settings.width = image.empty() ? static_cast<int>(own[1]) : static_cast<int>(image[1]);
    if ((own[0] != 0 && own[0] != settings.height) || (own[1] != 0 && own[1] != settings.width))
        refuse(kRefused, "takes images of " + std::to_string(own[0]) + " x " +
                             std::to_string(own[1]) + ", the spec says image [" +
                             std::to_string(settings.height) + ", " +
                             std::to_string(settings.width) + "]");
    take_transform(options, settings);
    for (int c = 0; c < kChannels; ++c) {
        settings.mean[c] = static_cast<float>(mean[static_cast<std::size_t>(c)]);
        settings.deviation[c] = static_cast<float>(deviation[static_cast<std::size_t>(c)]);
    }
    return settings;
}

Model read_model(const std::string& path, const std::string& output) {
    std::ifstream file(path, std::ios::binary);
    if (!file) refuse(kRefused, "cannot be read");
    Model model;
    model.bytes.assign(std::istreambuf_iterator<char>(file), {});
    if (model.bytes.starts_with("a model in Python\n"))
        refuse(kRefused,
               "stands for a model in Python: etlc.embed(..., encoder=...) runs it there");
    auto interface = interface_of(model.bytes);
    if (!interface) refuse(kRefused, "is no ONNX model, or a damaged one");
    choose_output(*interface, output);
    check_interface(*interface);
    model.interface = std::move(*interface);
    return model;
}

/// Makes one vector of an output. `pool`: "cls", the first of 1 x tokens x numbers; "mean", the
/// mean of all tokens, or of all places of 1 x numbers x rows x columns; "", all numbers as they
/// are.
std::span<const float> pooled(const Network::Output& output, const std::string& pool,
                              std::vector<float>& mean) {
    const Extents& shape = output.shape;
    if (pool.empty() || output.values.empty()) return output.values;
    const bool is_tokens = shape.size() == 3 && shape[0] == 1;
    const bool is_map = shape.size() == 4 && shape[0] == 1 && pool == "mean";
    if (!is_tokens && !is_map)
        refuse(kRefused, "gives " + shape_text(shape) + ", and pool " + pool +
                             (pool == "cls" ? " takes 1 x tokens x numbers"
                                            : " takes 1 x tokens x numbers or 1 x numbers x rows x "
                                              "columns"));
    const auto numbers = static_cast<std::size_t>(is_map ? shape[1] : shape[2]);
    if (pool == "cls") return output.values.first(numbers);
    const std::size_t places = output.values.size() / numbers;
    const std::size_t stride = is_map ? 1 : numbers;  // to the next place
    mean.resize(numbers);
    for (std::size_t i = 0; i < numbers; ++i) {
        const float* const first = output.values.data() + (is_map ? i * places : i);
        double sum = 0;
        for (std::size_t place = 0; place < places; ++place) sum += double{first[place * stride]};
        mean[i] = static_cast<float>(sum / static_cast<double>(places));
    }
    return mean;
}

/// Reads the next frame; false at the end.
bool read_frame(Frame& frame) {
    char head[8];
    if (!read_in(head, sizeof head)) return false;
    const std::uint32_t height = recordings::frames::number_at(head);
    const std::uint32_t width = recordings::frames::number_at(head + 4);
    const std::uint64_t pixels = std::uint64_t{height} * width;
    if (pixels == 0 || height > kMaxExtent || width > kMaxExtent || pixels > kMaxPixels)
        refuse(kWrongCall, "standard input holds no frames");
    frame.height = static_cast<int>(height);
    frame.width = static_cast<int>(width);
    frame.rgb.resize(kChannels * pixels);
    if (!read_in(frame.rgb.data(), frame.rgb.size())) refuse(kWrongCall, "a frame ends too soon");
    return true;
}

}  // namespace

void say_onnxruntime(const Words& options) {
    const Library library = load_onnxruntime(options.text("--onnxruntime", ""));
    const std::string lines = library.version + "\n" + library.path + "\n";
    write_out(lines.data(), lines.size());
}

void encode(const std::string& path, const Words& options) {
    static_assert(std::endian::native == std::endian::little);
    Model model = read_model(path, options.text("--output", ""));
    const std::string pool = options.text("--pool", "");
    const Settings settings = settings_of(options, model.interface.inputs[0]);
    model.height = settings.height;
    model.width = settings.width;
    Network network(load_onnxruntime(options.text("--onnxruntime", "")), model);
    std::vector<float> image(settings.elements()), mean;
    Frame frame;
    std::size_t dimension = 0;
    for (std::uint64_t n = 0; read_frame(frame); ++n) {
        prepare(frame, settings, image);
        const std::span<const float> embedding = pooled(network.run(image), pool, mean);
        if (n == 0) {
            dimension = embedding.size();
            if (dimension == 0) refuse(kRefused, "gives no number, expected an embedding");
            write_number(static_cast<std::uint32_t>(dimension));
        }
        if (embedding.size() != dimension)
            refuse(kRefused, "gives " + std::to_string(embedding.size()) + " numbers for frame " +
                                 std::to_string(n) + " and " + std::to_string(dimension) +
                                 " for those before, expected an embedding of one length");
        write_out(embedding.data(), embedding.size_bytes());
    }
}

// etlc-embed: everything but video.

namespace {

using namespace recordings::frames;
using Strings = std::vector<std::string>;

/// Replaces this process by the program beside it that decodes video.
void become_video_decoder(const Strings& words) {
    std::error_code error;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
    const std::string program = self.parent_path() / kVideoDecoder;
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    ::execv(program.c_str(), arguments.data());
    refuse(kRefused, program +
                         ", which decodes video, cannot be run: the Debian package etlc-embed "
                         "has it");
}

void run(const Strings& words) {
    const std::string command = words.empty() ? "" : words[0];
    const auto rest = [&](std::size_t from) {
        return Strings(words.begin() + static_cast<std::ptrdiff_t>(from), words.end());
    };
    if (command == "images") {
        limit_resources(kMaxMemoryBytes);
        send_images(rest(1));
    } else if (command == "given") {
        limit_resources(kMaxMemoryBytes);
        send_given_images();
    } else if (command == "png") {
        write_png();
    } else if (command == "video") {
        become_video_decoder(words);
    } else if (command == "encode" && words.size() >= 2) {
        limit_resources(0);
        encode(words[1], Words(rest(2)));
    } else if (command == "onnxruntime") {
        say_onnxruntime(Words(rest(1)));
    } else {
        refuse(kWrongCall,
               "etlc-embed belongs to etlc: etlc-embed images FILE..., etlc-embed given, "
               "etlc-embed png, etlc-embed video FILE, etlc-embed encode MODEL.onnx, etlc-embed "
               "onnxruntime");
    }
}

}  // namespace

}  // namespace etlc::embed::worker

int main(int argc, char** argv) {
    return etlc::embed::worker::guarded(argc, argv, etlc::embed::worker::run);
}
