// One client's session: its life, its documents, and who answers what.
// Takes: messages. Gives: responses and notifications, through `send`, in the order of the
// requests. Keeps true: every request gets exactly one response; no message ends the process but
// `exit`; findings of a document are published for its last state, and cleared when it closes.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "lsp/protocol/reader.hpp"
#include "lsp/spec/document.hpp"
#include "lsp/text/json.hpp"

namespace etlc::lsp {

/// What the client can show.
struct Client {
    bool related_places = false;  ///< of a finding
    bool hover_in_markdown = false;
    bool hierarchical_symbols = false;
};

class Session {
public:
    using Send = std::function<void(const Json&)>;

    explicit Session(Send send) : send_(std::move(send)) {}

    void receive(const Frame& frame);
    /// Publishes what is new. To be called when there is no message to read at present, so that of
    /// a burst of edits only the last state is looked at.
    void catch_up();
    /// Work for when the client has been quiet for a moment: what only planning finds.
    bool has_idle_work() const;
    /// How long it has to be quiet: longer where planning took long, since no message is read then.
    std::chrono::milliseconds pause() const;
    void do_idle_work();

    /// Once the client has said `exit`.
    std::optional<int> exit_status() const { return exit_status_; }
    /// Where its messages end without it.
    int status_at_end() const { return life_ == Life::shut_down ? 0 : 1; }

private:
    enum class Life : std::uint8_t { new_born, running, shut_down };
    using Request = Json (Session::*)(const Json& params);
    using Notification = void (Session::*)(const Json& params);

    void receive(const Json& message);
    void answer(const Json& id, const std::string& method, const Json& params);
    void take_note(const std::string& method, const Json& params);
    Json result_of(const std::string& method, const Json& params);
    void respond_error(const Json& id, ErrorCode code, const std::string& message);
    void log(const std::string& message);
    void publish(Document& document);

    static const std::map<std::string_view, Request>& requests();
    static const std::map<std::string_view, Notification>& notifications();

    // session.cpp
    Json initialize(const Json& params);
    Json shutdown(const Json& params);
    void initialized(const Json& params);
    void exit(const Json& params);
    void opened(const Json& params);
    void changed(const Json& params);
    void saved(const Json& params);
    void closed(const Json& params);
    void files_changed(const Json& params);

    // requests.cpp
    Json hover(const Json& params);
    Json definition(const Json& params);
    Json references(const Json& params);
    Json highlights(const Json& params);
    Json prepare_rename(const Json& params);
    Json rename(const Json& params);
    Json completion(const Json& params);
    Json symbols(const Json& params);
    Json code_actions(const Json& params);
    Json formatting(const Json& params);

    /// Throws Refusal where it is not open.
    Document& document_of(const Json& params);

    Send send_;
    Life life_ = Life::new_born;
    std::optional<int> exit_status_;
    Encoding encoding_ = Encoding::utf16;
    Client client_;
    std::map<std::string, Document> documents_;
    std::chrono::milliseconds last_planning_{0};
};

}  // namespace etlc::lsp
