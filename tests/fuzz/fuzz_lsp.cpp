// Runs the language server: any bytes get one answer per request, and a document stays valid under
// any edits. The first byte selects the meaning of the others: a client's bytes, one message per
// line, or a text and its edits.
#include <nlohmann/json.hpp>

#include "fuzz_target.hpp"
#include "lsp/protocol/session.hpp"

namespace {

using namespace etlc;
using lsp::Json;

/// A session that counts requests and answers.
class Client {
public:
    Client() : session_([this](const Json& message) { take(message); }) {}

    void tell(const char* method, Json params) {
        receive({{"jsonrpc", "2.0"}, {"method", method}, {"params", std::move(params)}});
    }

    Json ask(const char* method, Json params) {
        answer_ = nullptr;
        const std::size_t before = answers_;
        receive({{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", std::move(params)}});
        fuzz::require(answers_ == before + 1, "a request has one answer");
        return answer_;
    }

    void receive(const Json& message) { session_.receive(lsp::Frame{message.dump(), {}}); }
    void receive(const lsp::Frame& frame) { session_.receive(frame); }
    void catch_up() { session_.catch_up(); }
    std::size_t answers() const { return answers_; }

private:
    void take(const Json& message) {
        fuzz::require(message.at("jsonrpc") == "2.0", "it speaks JSON-RPC 2.0");
        (void)lsp::framed(message);
        if (!message.contains("id")) return;
        ++answers_;
        fuzz::require(message.contains("result") != message.contains("error"),
                      "an answer is a result or an error");
        if (message.contains("result")) answer_ = message["result"];
    }

    lsp::Session session_;
    Json answer_;
    std::size_t answers_ = 0;
};

constexpr const char* kUri = "untitled:a.etl";

/// Sends the bytes unchanged, in two pieces.
void send_bytes(std::string_view bytes) {
    Client client;
    lsp::Reader reader;
    for (const std::string_view piece :
         {bytes.substr(0, bytes.size() / 2), bytes.substr(bytes.size() / 2)}) {
        reader.add(piece);
        while (const auto frame = reader.next()) client.receive(*frame);
        client.catch_up();
    }
}

/// Sends each line as the content of a message, after a valid beginning.
void send_lines(std::string_view bytes) {
    Client client;
    client.ask("initialize", {{"capabilities", Json::object()}});
    while (!bytes.empty()) {
        const std::size_t end = std::min(bytes.find('\n'), bytes.size());
        client.receive(lsp::Frame{std::string(bytes.substr(0, end)), {}});
        client.catch_up();
        bytes.remove_prefix(std::min(bytes.size(), end + 1));
    }
}

/// Bytes that are not UTF-8 cannot be part of a message.
std::string as_text(std::string_view bytes) {
    return Json::parse(Json(bytes).dump(-1, ' ', false, Json::error_handler_t::replace));
}

void edit(std::string_view bytes) {
    const std::size_t cut = std::min(bytes.find('\0'), bytes.size());
    const std::string text = as_text(bytes.substr(0, cut));
    Client client;
    client.ask("initialize", {{"capabilities", Json::object()}});
    const Json document{{"uri", kUri}, {"version", 1}, {"text", text}};
    client.tell("textDocument/didOpen", {{"textDocument", document}});
    client.catch_up();
    bytes.remove_prefix(std::min(bytes.size(), cut + 1));
    // Four bytes give the begin and end of an edit; the rest up to a zero byte is inserted.
    for (int edits = 0; edits < 8 && bytes.size() > 4; ++edits) {
        const auto number = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
        const Json start{{"line", number(0)}, {"character", number(1)}};
        const Json end{{"line", number(2)}, {"character", number(3)}};
        const std::size_t size = std::min(bytes.find('\0', 4), bytes.size());
        client.tell("textDocument/didChange",
                    {{"textDocument", {{"uri", kUri}, {"version", edits + 2}}},
                     {"contentChanges",
                      {{{"range", {{"start", start}, {"end", end}}},
                        {"text", as_text(bytes.substr(4, size - 4))}}}}});
        bytes.remove_prefix(std::min(bytes.size(), size + 1));
        client.catch_up();
        Json place{{"textDocument", {{"uri", kUri}}}, {"position", start}, {"newName", "other"}};
        place["range"] = {{"start", start}, {"end", end}};
        for (const char* method :
             {"hover", "definition", "references", "documentHighlight", "prepareRename", "rename",
              "completion", "documentSymbol", "codeAction"})
            client.ask((std::string("textDocument/") + method).c_str(), place);
    }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* found, std::size_t size) {
    if (size == 0) return 0;
    const std::string_view bytes = fuzz::text(found + 1, size - 1);
    switch (found[0] % 3) {
        case 0: send_bytes(bytes); break;
        case 1: send_lines(bytes); break;
        default: edit(bytes); break;
    }
    return 0;
}
