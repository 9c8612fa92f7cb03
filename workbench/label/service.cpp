#include "label/service.hpp"

#include <sys/random.h>
#include <unistd.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <exception>
#include <filesystem>
#include <utility>

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

namespace {

using namespace std::chrono_literals;

constexpr auto kQuiet = 700ms;            ///< without a key, before proposals are made
constexpr int kMaxSilenceSeconds = 3600;  ///< of the process that makes them

/// Runs this program. Returns its output, or a sentence in place of proposals.
std::string output_of(const std::vector<std::string>& call) {
    const auto none = [](const std::string& why) {
        return nlohmann::json{{"why_none", "the process that makes them " + why},
                              {"proposals", nlohmann::json::array()}}
            .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    };
    std::error_code error;
    const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
    const auto child = data::Child::start(
        self.string(), call,
        {.max_silence_seconds = kMaxSilenceSeconds, .whole_environment = true, .heard = true});
    if (!child) return none("cannot be started");
    std::string output;
    while (!child->at_end()) {
        const std::size_t before = output.size();
        const std::size_t more = child->arrived();
        output.resize(before + more);
        child->read(output.data() + before, more);
    }
    if (!output.empty()) return output;
    const int status = child->exit_status();
    return none(status < 0 ? child->ending() : "failed: " + child->last_words());
}

/// Whether enough episodes are labelled, and not all.
bool can_learn_from(const Desk& desk) {
    const std::size_t labelled = labelled_episodes(desk).size();
    return labelled >= kEnoughLabelled && labelled < desk.episodes().size();
}

/// Returns the labels of the episodes that are fully labelled, as text to compare.
std::string lesson_of(const Desk& desk) {
    std::string text;
    for (std::size_t e = 0; e < desk.episodes().size(); ++e) {
        if (!desk.is_labelled(e)) continue;
        text += fmt::format("{}:", e);
        for (std::size_t p = 0; p < desk.predicates().size(); ++p)
            for (const Interval& one : desk.marks(e, p).value_or(std::vector<Interval>()))
                text +=
                    fmt::format("{} {} {} {};", p, one.start, one.end, static_cast<int>(one.label));
    }
    return text;
}

}  // namespace

void Background::look_after(const Desk& desk) {
    if (std::exchange(seen_, desk.version()) != desk.version()) {
        changed_ = Clock::now();
        is_due_ = can_learn_from(desk);
        if (running_.valid()) learned_.clear();  // it may have read these labels or those before
    }
    if (running_.valid() && running_.wait_for(0s) == std::future_status::ready) {
        auto parsed = parse_proposals(running_.get(), desk);
        proposals_ = parsed ? std::move(*parsed) : Proposals{"they cannot be read", {}};
        ++version_;
    }
    if (running_.valid() || Clock::now() - changed_ < kQuiet) return;
    is_due_ = false;
    if (!can_learn_from(desk)) return;
    std::string lesson = lesson_of(desk);
    if (lesson == learned_) return;
    try {
        running_ = std::async(std::launch::async, output_of, call_);
        learned_ = std::move(lesson);
    } catch (const std::exception&) {  // no thread can be started now
        changed_ = Clock::now();
        is_due_ = true;
    }
}

}  // namespace etlc::label
