// The page of `etlc watch`: the frame, the distances and the verdicts of each step, as it comes.
// Takes: steps. Gives: events for the pages that are open. Keeps true: nothing here waits for a
// page; a step and its frame are one event, so that a page shows them together. A page that is too
// slow misses frames, and the steps with them.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "data/files/file.hpp"
#include "diag/diag.hpp"
#include "execute/evaluator.hpp"
#include "label/service.hpp"
#include "recordings/frames/frames.hpp"
#include "report/document.hpp"

namespace etlc::watch {

/// The text of the page, before its first event.
struct PageText {
    std::string spec_path;
    std::string source;  ///< what is watched
    bool has_frames = false;
};
std::string page_of(const plan::Plan& plan, const PageText& text);

/// Returns a step as JSON without its end: "{"step":5,...".
std::string step_json(const plan::Plan& plan, std::uint64_t step,
                      const std::vector<etlmon::Verdict>& verdicts,
                      const execute::Evaluator& evaluator);

class Page {
public:
    /// Begins to serve the page; `port`: 0 for any free one.
    static diag::Result<std::unique_ptr<Page>> start(std::uint32_t port, std::string html);
    Page(const Page&) = delete;
    Page& operator=(const Page&) = delete;
    ~Page();

    const std::string& address() const { return service_->address(); }
    /// Adds a step. `step`: of step_json; `frame`: null where it has none.
    void add(std::string step, const recordings::Frame* frame);
    /// Returns once why the page is served no more; else nothing.
    std::optional<std::string> take_ending();

private:
    Page(std::unique_ptr<label::Service> service, std::string html);
    void serve();
    label::Answer answer(const label::Asked& asked);
    void send_events();

    std::unique_ptr<label::Service> service_;
    std::string html_;
    data::Descriptor wake_;           ///< can be read where there are events to send, or the end
    std::atomic<int> listeners_ = 0;  ///< pages that are open
    std::atomic<bool> is_ended_ = false;
    std::mutex mutex_;
    std::deque<std::string> past_;    ///< the last steps, for a page that is opened now
    std::deque<std::string> events_;  ///< to be sent
    std::optional<std::string> ending_;
    std::thread thread_;
};

// The files of the page, embedded when etlc was built.

const std::vector<report::PageFile>& page_files();

}  // namespace etlc::watch
