#include "watch/page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "check/guarantees/guarantees.hpp"
#include "label/frames.hpp"
#include "label/serve.hpp"
#include "report/pictures.hpp"
#include "report/report.hpp"
#include "report/tracks.hpp"

namespace etlc::watch {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kMostSide = 320;  ///< pixels of a frame on the page
constexpr std::size_t kPast = 600;        ///< steps that a page shows
constexpr std::size_t kMostEvents = 8;    ///< that wait; a page is not worth more memory

/// Returns a number as JSON, which has no infinities.
std::string number(float value) {
    if (std::isnan(value)) return "null";
    if (std::isinf(value)) return value > 0 ? "\"Infinity\"" : "\"-Infinity\"";
    return fmt::format("{}", value);
}

}  // namespace

std::string page_of(const plan::Plan& plan, const PageText& text) {
    const check::Model& model = *plan.model;
    Json data{
        {"spec",
         {{"name", model.name}, {"path", text.spec_path}, {"step_seconds", model.step_seconds}}},
        {"source", text.source},
        {"frames", text.has_frames},
        {"past", kPast},
        {"predicates", Json::array()},
        {"monitors", Json::array()}};
    for (const check::Index p : plan.predicates) {
        const check::Predicate& predicate = model.predicates[p];
        data["predicates"].push_back({{"shown", predicate.shown()},
                                      {"expression", check::print(model, predicate.expression)},
                                      {"comparison", symbol(predicate.comparison)},
                                      {"thresholds", report::levels(predicate.threshold)}});
    }
    for (const plan::Monitor& monitor : plan.monitors)
        data["monitors"].push_back(
            {{"name", monitor.name},
             {"formula", check::shown(model, model.monitors[monitor.index].formula)},
             {"sliding", monitor.sliding}});
    return label::page_with(page_files(), "watch.html",
                            data.dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::string step_json(const plan::Plan& plan, std::uint64_t step,
                      const std::vector<etlmon::Verdict>& verdicts,
                      const execute::Evaluator& evaluator) {
    std::vector<std::string> distance, robustness, lower, upper;
    std::vector<std::uint32_t> holds, said;
    for (const check::Index p : plan.predicates) {
        distance.push_back(number(evaluator.distance(p)));
        holds.push_back(report::code_of(plan.model->predicates[p].called(evaluator.distance(p))));
    }
    for (const etlmon::Verdict& verdict : verdicts) {
        robustness.push_back(number(verdict.robustness));
        lower.push_back(number(verdict.lower));
        upper.push_back(number(verdict.upper));
        said.push_back(report::code_of(verdict));
    }
    return fmt::format(
        "{{\"step\":{},\"distance\":[{}],\"holds\":[{}],\"robustness\":[{}],\"lower\":[{}],"
        "\"upper\":[{}],\"status\":[{}]",
        step, fmt::join(distance, ","), fmt::join(holds, ","), fmt::join(robustness, ","),
        fmt::join(lower, ","), fmt::join(upper, ","), fmt::join(said, ","));
}

diag::Result<std::unique_ptr<Page>> Page::start(std::uint32_t port, std::string html) {
    auto service = label::Service::start(port);
    if (!service) return service.failure();
    return std::unique_ptr<Page>(new Page(std::move(*service), std::move(html)));
}

Page::Page(std::unique_ptr<label::Service> service, std::string html)
    : service_(std::move(service)),
      html_(std::move(html)),
      wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      thread_([this] { serve(); }) {}

Page::~Page() {
    is_ended_ = true;
    ::eventfd_write(*wake_, 1);
    thread_.join();
}

void Page::add(std::string step, const recordings::Frame* frame) {
    std::string event;
    if (listeners_ > 0) {
        event = step;
        if (frame != nullptr) {
            const report::Picture picture =
                report::shrunk(frame->rgb, frame->width, frame->height, 3, kMostSide);
            const label::ImageFile file = label::bitmap(picture);
            event +=
                ",\"frame\":\"data:" + file.type + ";base64," + report::base64(file.bytes) + '"';
        }
        event += '}';
    }
    const std::lock_guard lock(mutex_);
    past_.push_back(std::move(step) + '}');
    if (past_.size() > kPast) past_.pop_front();
    if (event.empty()) return;
    events_.push_back(std::move(event));
    if (events_.size() > kMostEvents) events_.pop_front();
    ::eventfd_write(*wake_, 1);
}

void Page::serve() {
    while (!is_ended_ && !service_->has_ended()) {
        if (const auto asked = service_->next(*wake_)) service_->answer(answer(*asked));
        send_events();
    }
    if (is_ended_) return;
    const std::lock_guard lock(mutex_);
    ending_ = service_->ending().message;
}

std::optional<std::string> Page::take_ending() {
    const std::lock_guard lock(mutex_);
    return std::exchange(ending_, std::nullopt);
}

void Page::send_events() {
    std::deque<std::string> events;
    {
        const std::lock_guard lock(mutex_);
        eventfd_t unused = 0;
        ::eventfd_read(*wake_, &unused);
        std::swap(events, events_);
    }
    for (const std::string& event : events) service_->publish(event);
}

label::Answer Page::answer(const label::Asked& asked) {
    if (asked.path == "/") return {200, "text/html; charset=utf-8", html_};
    if (asked.path == "/events") {
        ++listeners_;
        const std::lock_guard lock(mutex_);
        return {200, "application/json", fmt::format("{{\"past\":[{}]}}", fmt::join(past_, ","))};
    }
    if (asked.path == "/events/end") {
        --listeners_;
        return {200, "text/plain", ""};
    }
    return {404, "text/plain; charset=utf-8", "there is nothing here"};
}

}  // namespace etlc::watch
