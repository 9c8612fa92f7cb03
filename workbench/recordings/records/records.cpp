#include "recordings/records/records.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <cstring>

#include "data/files/file.hpp"
#include "data/text/text.hpp"

namespace etlc::recordings {

using namespace data;
namespace {

using diag::Failure;
using records::Cause;
using records::Tag;

/// Makes the text of a reader printable. The reader has escaped names from the file, but the file
/// may control the reader.
std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text.substr(0, 1000)) result += c >= 0x20 && c < 0x7f ? c : '?';
    return result;
}

}  // namespace

diag::Result<std::shared_ptr<Records>> Records::start(std::string_view program,
                                                      const char* variable, const char* what,
                                                      const Codes& codes, const std::string& path,
                                                      const std::vector<std::string>& arguments) {
    if (auto why = why_unreadable(path)) return Failure{codes.unreadable, *why};
    const char* const named = std::getenv(variable);
    const std::string reader = named != nullptr ? named : helper_path(program);
    auto child =
        Child::start(reader, arguments, {.max_silence_seconds = records::kMaxSilenceSeconds});
    if (!child)
        return Failure{codes.unreadable, fmt::format("{} cannot be run, which reads {} files",
                                                     in_quotes(reader), what)};
    return std::shared_ptr<Records>(new Records(std::move(child), codes));
}

diag::Result<Tag> Records::next() {
    std::array<char, 5> head{};
    std::uint32_t length = 0;
    if (!child_->read(head.data(), head.size())) return stopped();
    std::memcpy(&length, head.data() + 1, sizeof length);
    if (length > records::kMaxRecordBytes) return nonsense();
    bytes_.resize(length);
    if (!child_->read(bytes_.data(), length)) return stopped();
    const auto tag = static_cast<Tag>(head[0]);
    if (tag == Tag::failure) {
        if (length < 2) return nonsense();
        return Failure{code_of(bytes_[0]), escaped(std::string_view(bytes_).substr(1))};
    }
    return tag;
}

Failure Records::nonsense() const {
    return {codes_.malformed, "is damaged: what came back from reading it makes no sense"};
}

diag::Code Records::code_of(char cause) const {
    switch (static_cast<Cause>(cause)) {
        case Cause::channel: return codes_.no_channel;
        case Cause::elements: return codes_.elements;
        case Cause::array:
        case Cause::file: break;
    }
    return codes_.malformed;
}

Failure Records::stopped() {
    return {codes_.malformed,
            fmt::format("is damaged or too much to read: the process that read it {}",
                        child_->ending())};
}

}  // namespace etlc::recordings
