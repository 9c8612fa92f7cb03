// A client's session: its state, its documents, and the dispatch of its messages.
// Takes: messages. Gives: responses and notifications, through `send`, in the order of the
// requests.
// Keeps true: every request gets exactly one response; only `exit` ends the process;
// findings are published for the last state of a document, and cleared when it closes.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "lsp/answers/answers.hpp"
#include "lsp/text/json.hpp"

namespace etlc::lsp {

// Splits the input of the server into messages: headers, an empty line, content.
// Takes: bytes, in pieces of any size. Gives: the content of each message, or an error in a frame.
// Keeps true: any bytes are accepted, in linear time; at most kMostContent bytes are kept; after a
// broken frame it continues with the next Content-Length.

/// The largest spec (1 MiB), each byte of it escaped.
inline constexpr std::uint64_t kMostContent = 8U << 20U;

struct Frame {
    std::string content;
    std::string mistake;  ///< error; "" for a valid frame
};

class Reader {
public:
    void add(std::string_view bytes);
    /// Returns the next frame; nothing where more bytes are needed.
    std::optional<Frame> next();

private:
    std::optional<Frame> end_of_headers();
    void take_header(std::string line);
    std::optional<std::string> line();
    std::optional<Frame> content();
    void forget_consumed();

    std::string bytes_;
    std::size_t at_ = 0;        ///< consumed bytes of `bytes_`
    std::size_t searched_ = 0;  ///< no line end before this place
    bool in_content_ = false;
    std::optional<std::uint64_t> length_;
    std::uint64_t skipped_ = 0;  ///< remaining bytes of content that is too long
    std::string mistake_;        ///< error in the headers so far
    bool has_headers_ = false;
};

class Session {
public:
    using Send = std::function<void(const Json&)>;

    explicit Session(Send send) : send_(std::move(send)) {}

    void receive(const Frame& frame);
    /// Publishes new findings. Call it when no message is waiting, so that only the last state of a
    /// burst of edits is analysed.
    void catch_up();
    /// Returns whether a document waits to be planned, which begins when the client is idle.
    bool has_idle_work() const;
    /// Plans one document.
    void do_idle_work();

    /// Returns the exit status after `exit`.
    std::optional<int> exit_status() const { return exit_status_; }
    /// Returns the exit status where the input ends without `exit`.
    int status_at_end() const { return life_ == Life::shut_down ? 0 : 1; }

private:
    enum class Life : std::uint8_t { new_born, running, shut_down };
    using Notification = void (Session::*)(const Json& params);

    void receive(const Json& message);
    void answer(const Json& id, const std::string& method, const Json& params);
    void take_note(const std::string& method, const Json& params);
    Json result_of(const std::string& method, const Json& params);
    void respond_error(const Json& id, ErrorCode code, const std::string& message);
    void notify(const char* method, Json params);
    void log(const std::string& message);
    void publish(Document& document);

    static const std::map<std::string_view, Notification>& notifications();

    Json initialize(const Json& params);
    void opened(const Json& params);
    void changed(const Json& params);
    void saved(const Json& params);
    void closed(const Json& params);
    void files_changed(const Json& params);

    /// Throws Refusal where the document is not open.
    Document& document_of(const Json& params);

    Send send_;
    Life life_ = Life::new_born;
    std::optional<int> exit_status_;
    Encoding encoding_ = Encoding::utf16;
    Client client_;
    std::map<std::string, Document> documents_;
};

}  // namespace etlc::lsp
