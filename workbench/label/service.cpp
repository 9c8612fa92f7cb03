#include "label/service.hpp"

#include <fmt/format.h>
#include <sys/random.h>
#include <unistd.h>

#include "label/server/protocol.hpp"

namespace etlc::label {

namespace {

using diag::Code;
using diag::Failure;
using recordings::frames::number_at;

constexpr std::string_view kServer = "etlc-serve";
/// Longer than anybody labels: etlc-serve is silent while nobody does.
constexpr int kSilenceSeconds = 2'000'000;

std::string random_token() {
    std::string bytes(protocol::kTokenSize / 2, '\0');
    std::string token;
    if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) return "";
    for (const char c : bytes) token += fmt::format("{:02x}", static_cast<unsigned char>(c));
    return token;
}

}  // namespace

std::string what_serving_lacks() {
    const std::string path = data::helper_path(kServer);
    if (::access(path.c_str(), X_OK) == 0) return "";
    return fmt::format(
        "{} cannot be run, which serves the page; etlc builds it where it finds cpp-httplib "
        "(Debian: libcpp-httplib-dev); of the packages of etlc, etlc-serve has it",
        kServer);
}

diag::Result<std::unique_ptr<Service>> Service::start(std::uint32_t port) {
    const std::string token = random_token();
    auto child = token.empty()
                     ? nullptr
                     : data::Child::start(
                           data::helper_path(kServer), {},
                           {.max_silence_seconds = kSilenceSeconds, .fed = true, .heard = true});
    if (!child) return Failure{Code::unwritable_output, fmt::format("{} cannot be run", kServer)};
    std::unique_ptr<Service> service(new Service(std::move(child)));
    std::string head;
    recordings::frames::append(head, port);
    protocol::append(head, token);
    char bound[4];
    if (!service->child_->give(head) || !service->child_->read(bound, sizeof bound))
        return service->ending();
    service->address_ = fmt::format("http://127.0.0.1:{}/{}/", number_at(bound), token);
    return service;
}

std::optional<std::string> Service::read_text() {
    char size[4];
    has_ended_ = has_ended_ || !child_->read(size, sizeof size) ||
                 number_at(size) > 2 * protocol::kMostContent;
    if (has_ended_) return std::nullopt;
    std::string text(number_at(size), '\0');
    has_ended_ = !child_->read(text.data(), text.size());
    if (has_ended_) return std::nullopt;
    return text;
}

std::optional<Asked> Service::next(int or_this) {
    if (or_this >= 0 && child_->arrived() == 0) data::Child::await({child_.get()}, {or_this}, -1);
    has_ended_ = has_ended_ || child_->is_over();
    if (has_ended_ || (or_this >= 0 && child_->arrived() == 0)) return std::nullopt;
    auto path = read_text();
    auto content = path ? read_text() : std::nullopt;
    if (!content) return std::nullopt;
    return Asked{std::move(*path), std::move(*content)};
}

bool Service::answer(const Answer& answer) {
    std::string bytes;
    recordings::frames::append(bytes, answer.status);
    protocol::append(bytes, answer.type);
    protocol::append(bytes, answer.content);
    has_ended_ = has_ended_ || !child_->give(bytes);
    return !has_ended_;
}

bool Service::publish(std::string_view event) {
    std::string bytes;
    recordings::frames::append(bytes, protocol::kEvent);
    protocol::append(bytes, event);
    has_ended_ = has_ended_ || !child_->give(bytes);
    return !has_ended_;
}

Failure Service::ending() {
    const std::string said = child_->last_words();
    return {Code::unwritable_output,
            said.empty() ? fmt::format("{} {}", kServer, child_->ending()) : said};
}

}  // namespace etlc::label
