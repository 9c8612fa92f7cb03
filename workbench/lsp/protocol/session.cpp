#include "lsp/protocol/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "data/spill/spill.hpp"
#include "data/text/text.hpp"

namespace etlc::lsp {

namespace {

bool is_id(const Json& id) {
    return id.is_string() || id.is_number_integer();
}

bool is_true(const Json* found) {
    return found != nullptr && found->is_boolean() && found->get<bool>();
}

/// Chooses bytes where the client supports them, whatever it prefers: etlc counts in bytes.
Encoding encoding_for(const Json& params) {
    const Json* const offered = find_path(params, "capabilities/general/positionEncodings");
    if (offered == nullptr || !offered->is_array()) return Encoding::utf16;
    const bool has_utf8 = std::find(offered->begin(), offered->end(), "utf-8") != offered->end();
    return has_utf8 ? Encoding::utf8 : Encoding::utf16;
}

Json capabilities(Encoding encoding) {
    return {{"positionEncoding", encoding == Encoding::utf8 ? "utf-8" : "utf-16"},
            {"textDocumentSync",
             {{"openClose", true}, {"change", 2}, {"save", {{"includeText", false}}}}},
            {"hoverProvider", true},
            {"definitionProvider", true},
            {"referencesProvider", true},
            {"documentHighlightProvider", true},
            {"renameProvider", {{"prepareProvider", true}}},
            {"completionProvider", {{"triggerCharacters", {"[", "(", ","}}}},
            {"documentSymbolProvider", true},
            {"codeActionProvider", {{"codeActionKinds", {"quickfix"}}}}};
}

Client client_of(const Json& params) {
    Client client;
    const Json* const document = find_path(params, "capabilities/textDocument");
    if (document == nullptr) return client;
    client.related_places = is_true(find_path(*document, "publishDiagnostics/relatedInformation"));
    client.hierarchical_symbols =
        is_true(find_path(*document, "documentSymbol/hierarchicalDocumentSymbolSupport"));
    const Json* const formats = find_path(*document, "hover/contentFormat");
    client.hover_in_markdown =
        formats != nullptr && formats->is_array() &&
        std::find(formats->begin(), formats->end(), "markdown") != formats->end();
    return client;
}

const std::map<std::string_view, Json (*)(const Question&)>& answers() {
    static const std::map<std::string_view, Json (*)(const Question&)> all{
        {"textDocument/hover", hover},
        {"textDocument/definition", definition},
        {"textDocument/references", references},
        {"textDocument/documentHighlight", highlights},
        {"textDocument/prepareRename", prepare_rename},
        {"textDocument/rename", rename},
        {"textDocument/completion", completion},
        {"textDocument/documentSymbol", symbols},
        {"textDocument/codeAction", code_actions},
    };
    return all;
}

/// Returns the version of a document, which only the client uses.
std::int64_t version_of(const Json& document) {
    const Json* const found = find(document, "version");
    return found != nullptr && found->is_number_integer() ? found->get<std::int64_t>() : 0;
}

/// Does some work, and returns why it could not be done.
template <class Work>
std::optional<Refusal> refusal_of(const Work& work) {
    try {
        work();
        return std::nullopt;
    } catch (const Refusal& refusal) {
        return refusal;
    } catch (const std::bad_alloc&) {
        return Refusal{ErrorCode::request_failed, "there is not enough memory for this"};
    } catch (const data::SpillError& error) {
        return Refusal{ErrorCode::request_failed, error.what()};
    }
}

}  // namespace

void Session::receive(const Frame& frame) {
    if (!frame.mistake.empty())
        return respond_error(nullptr, ErrorCode::parse_error, frame.mistake);
    if (nests_too_deep(frame.content))
        return respond_error(nullptr, ErrorCode::parse_error, "the message nests too deep");
    const Json message = Json::parse(frame.content, nullptr, false);
    if (message.is_discarded())
        return respond_error(nullptr, ErrorCode::parse_error, "the message is not JSON");
    receive(message);
}

void Session::receive(const Json& message) {
    const Json* const id = find(message, "id");
    const Json* const method = find(message, "method");
    const Json* const version = find(message, "jsonrpc");
    const bool is_response =
        find(message, "result") != nullptr || find(message, "error") != nullptr;
    if (method == nullptr && id != nullptr && is_response)
        return;  // a response to a request that was never sent
    const Json known_id = id != nullptr && is_id(*id) ? *id : Json();
    const bool is_sound = version != nullptr && *version == "2.0" && method != nullptr &&
                          method->is_string() && (id == nullptr || is_id(*id));
    if (!is_sound)
        return respond_error(known_id, ErrorCode::invalid_request,
                             "this is no request or notification of JSON-RPC 2.0");
    static const Json kNone = Json::object();
    const Json* const params = find(message, "params");
    const auto& name = method->get_ref<const std::string&>();
    if (id != nullptr)
        answer(*id, name, params != nullptr ? *params : kNone);
    else
        take_note(name, params != nullptr ? *params : kNone);
}

void Session::answer(const Json& id, const std::string& method, const Json& params) {
    const auto refusal = refusal_of([&] {
        Json result = result_of(method, params);
        send_({{"jsonrpc", "2.0"}, {"id", id}, {"result", std::move(result)}});
    });
    if (refusal) respond_error(id, refusal->code, refusal->message);
}

Json Session::result_of(const std::string& method, const Json& params) {
    if (life_ == Life::new_born && method != "initialize")
        throw Refusal{ErrorCode::server_not_initialized, "expected 'initialize' first"};
    if (life_ == Life::shut_down)
        throw Refusal{ErrorCode::invalid_request, "expected 'exit' after 'shutdown'"};
    if (method == "initialize") return initialize(params);
    if (method == "shutdown") {
        life_ = Life::shut_down;
        return nullptr;
    }
    const auto found = answers().find(method);
    if (found == answers().end())
        throw Refusal{ErrorCode::method_not_found, fmt::format("there is no '{}' here", method)};
    return found->second({document_of(params), params, client_});
}

void Session::take_note(const std::string& method, const Json& params) {
    if (method == "exit") exit_status_ = status_at_end();
    if (life_ != Life::running) return;
    const auto found = notifications().find(method);
    if (found == notifications().end()) return;
    const auto refusal = refusal_of([&] { (this->*found->second)(params); });
    if (refusal) log(fmt::format("{}: {}", method, refusal->message));
}

void Session::respond_error(const Json& id, ErrorCode code, const std::string& message) {
    send_({{"jsonrpc", "2.0"},
           {"id", id},
           {"error", {{"code", static_cast<std::int32_t>(code)}, {"message", message}}}});
}

void Session::notify(const char* method, Json params) {
    send_({{"jsonrpc", "2.0"}, {"method", method}, {"params", std::move(params)}});
}

void Session::log(const std::string& message) {
    notify("window/logMessage", {{"type", 2}, {"message", message}});
}

const std::map<std::string_view, Session::Notification>& Session::notifications() {
    static const std::map<std::string_view, Notification> all{
        {"textDocument/didOpen", &Session::opened},
        {"textDocument/didChange", &Session::changed},
        {"textDocument/didSave", &Session::saved},
        {"textDocument/didClose", &Session::closed},
        {"workspace/didChangeWatchedFiles", &Session::files_changed},
    };
    return all;
}

// ---- state of the session -----------------------------------------------------------------------

Json Session::initialize(const Json& params) {
    if (life_ != Life::new_born)
        throw Refusal{ErrorCode::invalid_request, "the session is initialized already"};
    life_ = Life::running;
    encoding_ = encoding_for(params);
    client_ = client_of(params);
    return {{"capabilities", capabilities(encoding_)}, {"serverInfo", {{"name", "etlc"}}}};
}

// ---- documents ----------------------------------------------------------------------------------

Document& Session::document_of(const Json& params) {
    const auto found = documents_.find(uri_of(params));
    if (found == documents_.end())
        throw Refusal{ErrorCode::invalid_params, "this document is not open"};
    return found->second;
}

void Session::opened(const Json& params) {
    const Json& document = member(params, "textDocument");
    const std::string& uri = text_of(document, "uri");
    const std::string& text = text_of(document, "text");
    documents_.erase(uri);
    documents_.try_emplace(uri, uri, text, version_of(document), encoding_);
}

void Session::changed(const Json& params) {
    Document& document = document_of(params);
    const Json& changes = member(params, "contentChanges");
    if (!changes.is_array())
        throw Refusal{ErrorCode::invalid_params, "'contentChanges' is not a list"};
    document.set_version(version_of(member(params, "textDocument")));
    for (const Json& change : changes) {
        const std::string& text = text_of(change, "text");
        const Json* const range = find(change, "range");
        if (range == nullptr || range->is_null())
            document.replace(text);
        else
            document.replace(range_of(*range), text);
    }
}

void Session::saved(const Json& params) {
    document_of(params).forget();  // its thresholds may have been calibrated since
}

void Session::closed(const Json& params) {
    const std::string uri = document_of(params).uri();
    documents_.erase(uri);
    notify("textDocument/publishDiagnostics", {{"uri", uri}, {"diagnostics", Json::array()}});
}

void Session::files_changed(const Json& /*params*/) {
    for (auto& [uri, document] : documents_) document.forget();
}

void Session::publish(Document& document) {
    document.is_news = false;
    Json findings =
        diagnostics_of(document.analysis(), document.planned(), document.uri(), client_);
    notify("textDocument/publishDiagnostics", {{"uri", document.uri()},
                                               {"version", document.version()},
                                               {"diagnostics", std::move(findings)}});
}

void Session::catch_up() {
    if (life_ != Life::running) return;
    for (auto& [uri, document] : documents_)
        if (document.is_news) publish(document);
}

bool Session::has_idle_work() const {
    return life_ == Life::running &&
           std::any_of(documents_.begin(), documents_.end(),
                       [](const auto& entry) { return entry.second.needs_plan(); });
}

void Session::do_idle_work() {
    const auto found = std::find_if(documents_.begin(), documents_.end(),
                                    [](const auto& entry) { return entry.second.needs_plan(); });
    if (found == documents_.end()) return;
    const auto refusal = refusal_of([&] { found->second.plan(); });
    if (refusal) log(fmt::format("planning the monitors: {}", refusal->message));
}

namespace {

/// Longer than any header; the end of a longer line is kept, since a header may begin there.
constexpr std::size_t kLongestLine = 4096;
constexpr std::string_view kLength = "content-length";
constexpr std::string_view kType = "content-type";

std::string lower(std::string_view text) {
    std::string result(text);
    for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return result;
}

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

}  // namespace

void Reader::add(std::string_view bytes) {
    forget_consumed();
    bytes_ += bytes;
}

void Reader::forget_consumed() {
    bytes_.erase(0, at_);
    searched_ -= std::min(searched_, at_);
    at_ = 0;
}

std::optional<Frame> Reader::next() {
    while (true) {
        if (in_content_) return content();
        auto header = line();
        if (!header) return std::nullopt;
        if (!header->empty()) {
            take_header(std::move(*header));
        } else if (auto broken = end_of_headers()) {
            return broken;
        }
    }
}

std::optional<std::string> Reader::line() {
    searched_ = std::max(searched_, at_);
    const std::size_t end = bytes_.find('\n', searched_);
    if (end == std::string::npos) {
        searched_ = bytes_.size();
        if (bytes_.size() - at_ > kLongestLine) {
            mistake_ = "a header is too long";
            at_ = bytes_.size() - kLongestLine / 2;
            forget_consumed();
        }
        return std::nullopt;
    }
    std::string result = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    searched_ = at_;
    if (result.ends_with('\r')) result.pop_back();
    return result;
}

void Reader::take_header(std::string header) {
    has_headers_ = true;
    // After a broken frame the next header may share a line with the rest of it.
    const std::size_t begin = lower(header).rfind(std::string(kLength) + ":");
    if (begin != std::string::npos && begin > 0) {
        mistake_ = "expected a header, found something else";
        header.erase(0, begin);
    }
    const std::size_t colon = header.find(':');
    if (colon == std::string::npos) {
        mistake_ = "expected a header, found something else";
        return;
    }
    const std::string name = lower(trimmed(std::string_view(header).substr(0, colon)));
    const std::string_view value = trimmed(std::string_view(header).substr(colon + 1));
    if (name == kLength) {
        length_ = data::parse_whole<std::uint64_t>(value);
        if (!length_) mistake_ = "Content-Length is not a number of bytes";
    } else if (name == kType) {
        const std::string type = lower(value);
        const std::size_t charset = type.find("charset=");
        if (charset != std::string::npos && type.find("utf-8", charset) == std::string::npos &&
            type.find("utf8", charset) == std::string::npos)
            mistake_ = "the content is not UTF-8, as Content-Type says";
    }
}

std::optional<Frame> Reader::end_of_headers() {
    if (!has_headers_) return std::nullopt;  // an empty line between two messages
    has_headers_ = false;
    in_content_ = length_.has_value();
    skipped_ = 0;
    if (!in_content_ && mistake_.empty()) mistake_ = "there is no Content-Length";
    if (in_content_ && *length_ > kMostContent)
        mistake_ =
            fmt::format("a message of {} bytes; at most {} are read", *length_, kMostContent);
    if (mistake_.empty()) return std::nullopt;
    // Its content still follows, as a separate message.
    Frame broken{{}, std::move(mistake_)};
    mistake_.clear();
    return broken;
}

std::optional<Frame> Reader::content() {
    const std::size_t there = bytes_.size() - at_;
    if (*length_ > kMostContent) {
        const std::uint64_t taken = std::min<std::uint64_t>(there, *length_ - skipped_);
        at_ += static_cast<std::size_t>(taken);
        skipped_ += taken;
        forget_consumed();
        if (skipped_ < *length_) return std::nullopt;
        in_content_ = false;
        length_.reset();
        return next();
    }
    if (there < *length_) return std::nullopt;
    Frame frame{bytes_.substr(at_, static_cast<std::size_t>(*length_)), {}};
    at_ += static_cast<std::size_t>(*length_);
    in_content_ = false;
    length_.reset();
    return frame;
}

}  // namespace etlc::lsp
