#include "embed/encoder.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <bit>
#include <cmath>

#include "artifacts/embedded.hpp"
#include "data/files/file.hpp"
#include "recordings/frames/protocol.hpp"

namespace etlc::embed {

namespace {

using diag::Code;
using diag::Failure;
using recordings::frames::append;
using recordings::frames::number_at;

std::vector<std::string> network_arguments(const check::Encoder& encoder,
                                           const std::string& model_path,
                                           const std::string& onnxruntime) {
    std::vector<std::string> arguments = {"encode", model_path, "--onnxruntime", onnxruntime};
    const auto add = [&](const char* option, const std::string& value) {
        if (!value.empty()) arguments.insert(arguments.end(), {option, value});
    };
    const auto joined = [](const std::vector<float>& values) {
        return fmt::format("{}", fmt::join(values, ","));
    };
    add("--image", joined(encoder.image));
    add("--mean", joined(encoder.mean));
    add("--deviation", joined(encoder.deviation));
    add("--filter", encoder.filter);
    add("--resize", joined(encoder.resize));
    add("--flip", encoder.flip);
    add("--channels", encoder.channels);
    add("--margins", encoder.margins);
    add("--output", encoder.output);
    add("--pool", encoder.pool);
    return arguments;
}

struct Call {
    std::string program;
    std::vector<std::string> arguments;
    data::Child::Options options;
};

Call call_of(const check::Encoder& encoder, const std::string& model_path, const Running& running) {
    if (running.command.empty())
        return {recordings::embedder_path(),
                network_arguments(encoder, model_path, running.onnxruntime),
                {}};
    Call call{"/bin/sh", {"-c", running.command}, {}};
    call.options.whole_environment = true;
    call.options.variables = {"ETLC_ENCODER=" + encoder.name, "ETLC_MODEL=" + model_path};
    return call;
}

Failure not_run(const Running& running) {
    if (running.command.empty()) return recordings::no_embedder();
    return {Code::encoder_failed, "there is no shell to run the command"};
}

}  // namespace

diag::Diagnostic of_encoder(const Failure& failure, const check::Model& model,
                            const check::Encoder& encoder) {
    return data::in_file(failure, data::beside(model.file.path(), encoder.model))
        .note(encoder.span, fmt::format("'{}' is declared here", encoder.name));
}

std::optional<Failure> settle(Running& running) {
    if (!running.command.empty()) {
        running.kind = embedded::kCommand;
        return std::nullopt;
    }
    std::vector<std::string> words = {"onnxruntime"};
    if (!running.onnxruntime.empty())
        words.insert(words.end(), {"--onnxruntime", running.onnxruntime});
    // The environment locates packages.
    const auto child = data::Child::start(recordings::embedder_path(), words,
                                          {.max_silence_seconds = running.max_silence_seconds,
                                           .whole_environment = true,
                                           .heard = true});
    if (!child) return recordings::no_embedder();
    std::string lines;
    for (char c = 0; !child->at_end() && child->read(&c, 1);) lines += c;
    if (child->exit_status() == recordings::frames::kNoRuntime)
        return Failure{Code::no_embedder, child->last_words()};
    const std::size_t end = lines.find('\n');
    if (child->exit_status() != 0 || end == std::string::npos || lines.back() != '\n')
        return Failure{Code::no_embedder,
                       fmt::format("is not run: what loads ONNX Runtime {}", child->ending())};
    running.kind = std::string(embedded::kOnnxRuntime) + lines.substr(0, end);
    running.onnxruntime = lines.substr(end + 1, lines.size() - end - 2);
    return std::nullopt;
}

diag::Failure become(const check::Encoder& encoder, const std::string& model_path,
                     const Running& running) {
    const Call call = call_of(encoder, model_path, running);
    data::Child::become(call.program, call.arguments, call.options);
    return not_run(running);
}

diag::Result<std::unique_ptr<Encoder>> Encoder::start(const check::Encoder& encoder,
                                                      const std::string& model_path,
                                                      const Running& running) {
    Call call = call_of(encoder, model_path, running);
    call.options.max_silence_seconds = running.max_silence_seconds;
    call.options.fed = true;
    call.options.heard = true;
    auto child = data::Child::start(call.program, call.arguments, call.options);
    if (!child) return not_run(running);
    return std::unique_ptr<Encoder>(new Encoder(encoder, running, std::move(child)));
}

std::optional<Trouble> Encoder::add(recordings::FrameSource& frames, const std::string& name,
                                    Done done, const std::function<void()>& passed) {
    jobs_.push_back({name, 0, false, {}, std::move(done)});
    recordings::Frame frame;
    for (;;) {
        const auto more = frames.next(frame);
        if (!more) return Trouble{more.failure(), false, jobs_.back().frames};
        if (!*more) break;
        passed();
        if (auto failure = pass(frame)) return Trouble{std::move(*failure)};
        if (auto failure = take(false)) return Trouble{std::move(*failure)};
    }
    jobs_.back().complete = true;
    finish_jobs();
    return std::nullopt;
}

std::optional<Failure> Encoder::add(const recordings::Frame& frame, const std::string& name,
                                    Done done) {
    if (dimension_ > 0 && taken_ == given_ && child_->arrived() > 0) return surplus();
    jobs_.push_back({name, 0, true, {}, std::move(done)});
    return pass(frame);
}

std::optional<Failure> Encoder::pass(const recordings::Frame& frame) {
    std::string head;
    append(head, frame.height);
    append(head, frame.width);
    if (!child_->give(head) || !child_->give(frame.rgb)) return stopped();
    ++jobs_.back().frames;
    ++given_;
    return std::nullopt;
}

std::optional<Trouble> Encoder::finish() {
    child_->give_no_more();
    if (auto failure = take(true)) return Trouble{std::move(*failure)};
    has_surplus_ = !child_->at_end();
    if (has_surplus_) return Trouble{surplus()};
    if (child_->exit_status() != 0) return Trouble{stopped()};
    return std::nullopt;
}

std::optional<Failure> Encoder::take(bool all) {
    if (dimension_ == 0) {
        if (!all && child_->arrived() < 4) return std::nullopt;
        if (auto failure = take_dimension()) return failure;
    }
    const std::size_t row_bytes = 4 * std::size_t{dimension_};
    while (taken_ < given_ && (all || child_->arrived() >= row_bytes)) {
        for (Job& job : jobs_)
            if (job.rows.size() < job.frames * dimension_) {
                if (auto failure = take_row(job)) return failure;
                break;
            }
        finish_jobs();
    }
    return std::nullopt;
}

std::optional<Failure> Encoder::take_dimension() {
    std::array<char, 4> head{};
    if (!child_->read(head.data(), head.size())) return stopped();
    dimension_ = number_at(head.data());
    if (dimension_ == 0 || dimension_ > recordings::frames::kMaxDimension)
        return Failure{
            Code::encoder_failed,
            fmt::format("'{}' began with the dimension {}, expected 32 bits of a number from 1 "
                        "to {}",
                        name_, dimension_, recordings::frames::kMaxDimension)};
    if (expected_ != 0 && dimension_ != expected_)
        return Failure{
            Code::embedding_dimension,
            fmt::format("'{}' gives embeddings of dimension {}, the inputs by it have {}", name_,
                        dimension_, expected_)};
    return std::nullopt;
}

std::optional<Failure> Encoder::take_row(Job& job) {
    bytes_.resize(4 * std::size_t{dimension_});
    if (!child_->read(bytes_.data(), bytes_.size())) return stopped();
    const std::uint64_t row = job.rows.size() / dimension_;
    for (std::size_t i = 0; i < dimension_; ++i) {
        const auto value = std::bit_cast<float>(number_at(bytes_.data() + 4 * i));
        if (!std::isfinite(value))
            return Failure{
                Code::embedding_not_finite,
                fmt::format("'{}' gave {} at element {} of the embedding of {}, frame {} "
                            "(both from 0)",
                            name_, value, i, job.name, row)};
        job.rows.push_back(value);
    }
    ++taken_;
    return std::nullopt;
}

void Encoder::finish_jobs() {
    while (!jobs_.empty() && jobs_.front().complete && dimension_ > 0 &&
           jobs_.front().rows.size() == jobs_.front().frames * dimension_) {
        jobs_.front().done(std::move(jobs_.front().rows));
        jobs_.pop_front();
    }
}

Failure Encoder::surplus() const {
    return {Code::encoder_failed, fmt::format("'{}' wrote more than {}, one a frame", name_,
                                              diag::counted(taken_, "embedding"))};
}

Failure Encoder::stopped() {
    const std::string ending = child_->ending();
    const std::string words = child_->last_words();
    if (!is_command_ && child_->exit_status() == recordings::frames::kRefused)
        return {Code::encoder_refused, words};
    if (!is_command_ && child_->exit_status() == recordings::frames::kNoRuntime)
        return {Code::no_embedder, words};
    return {Code::encoder_failed,
            fmt::format("'{}' {}, after {}{}", name_, ending, diag::counted(taken_, "embedding"),
                        words.empty() ? "" : "; its last words: " + words)};
}

}  // namespace etlc::embed
