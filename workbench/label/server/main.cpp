// etlc-serve: passes requests of one page to `etlc label` or `etlc watch`, which answers them. It
// is a separate program, so that etlc links no library that listens to a network, and a fault there
// loses no label. It listens to the loopback alone, and refuses with 403 what lacks the token,
// comes from another origin, or was addressed to another name (DNS rebinding).
#include <httplib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "label/server/protocol.hpp"

namespace {

using namespace etlc::label::protocol;
using etlc::recordings::frames::number_at;

constexpr const char* kHost = "127.0.0.1";
constexpr int kGood = 200;
constexpr int kForbidden = 403;
constexpr const char* kEnd = "/events/end";       ///< a page has gone, which no page says itself
constexpr int kConnections = 512;                 ///< at a time; a browser opens six for a page
constexpr int kReadSeconds = 2;                   ///< for the next bytes of a request
constexpr std::size_t kMostRequests = 1'000'000;  ///< of a connection

bool read_all(char* to, std::size_t n) {
    while (n > 0) {
        const ssize_t got = ::read(STDIN_FILENO, to, n);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        to += got;
        n -= static_cast<std::size_t>(got);
    }
    return true;
}

std::optional<std::uint32_t> read_number() {
    char bytes[4];
    if (!read_all(bytes, sizeof bytes)) return std::nullopt;
    return number_at(bytes);
}

std::optional<std::string> read_text() {
    const auto size = read_number();
    if (!size || *size > kMostAnswer) return std::nullopt;
    std::string text(*size, '\0');
    if (!read_all(text.data(), text.size())) return std::nullopt;
    return text;
}

bool write_all(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
}

/// Compares in a time that does not tell where the two differ.
bool is_same(std::string_view a, std::string_view b) {
    unsigned char difference = a.size() == b.size() ? 0 : 1;
    for (std::size_t i = 0; i < a.size() && i < b.size(); ++i)
        difference = static_cast<unsigned char>(difference | (a[i] ^ b[i]));
    return difference == 0;
}

class Door {
public:
    Door(std::string token, int port) : token_(std::move(token)) {
        for (const char* const name : {kHost, "localhost"})
            hosts_.push_back(std::string(name) + ":" + std::to_string(port));
    }

    /// Returns the path behind the token, with its slash; nothing where the request is refused.
    std::optional<std::string> path(const httplib::Request& request) const {
        if (!is_ours(request.get_header_value("Host"), "")) return std::nullopt;
        if (request.has_header("Origin") && !is_ours(request.get_header_value("Origin"), "http://"))
            return std::nullopt;
        const std::string& path = request.path;
        if (path.size() < token_.size() + 2 || path[0] != '/' || path[token_.size() + 1] != '/' ||
            !is_same(std::string_view(path).substr(1, token_.size()), token_))
            return std::nullopt;
        return path.substr(token_.size() + 1);
    }

private:
    bool is_ours(const std::string& value, const std::string& before) const {
        for (const std::string& host : hosts_)
            if (value == before + host) return true;
        return false;
    }

    std::string token_;
    std::vector<std::string> hosts_;
};

/// Listens to etlc: to answers, and to events, of which the last ones are kept. Ends with etlc.
class Etlc {
public:
    struct Answer {
        int status = 0;
        std::string type;
        std::string content;
        std::uint64_t next_event = 0;  ///< the first event behind it
    };

    void listen() {
        std::thread([this] {
            while (take()) {
            }
            ::_exit(0);
        }).detach();
    }

    /// Passes a request on, one at a time.
    Answer ask(const std::string& path, const std::string& content) {
        const std::lock_guard turn(turn_);
        std::string asked;
        append(asked, path);
        append(asked, content);
        if (!write_all(asked)) ::_exit(0);
        std::unique_lock lock(mutex_);
        said_.wait(lock, [this] { return answer_.has_value(); });
        return *std::exchange(answer_, std::nullopt);
    }

    /// Waits for an event from this number on, and moves the number behind it; a page that is too
    /// slow misses some. Nothing where there is none for a moment.
    std::shared_ptr<const std::string> event(std::uint64_t& number) {
        std::unique_lock lock(mutex_);
        const auto is_there = [&] { return number < first_ + events_.size(); };
        if (!said_.wait_for(lock, kMoment, is_there)) return nullptr;
        number = std::max(number, first_);
        return events_[number++ - first_];
    }

private:
    static constexpr std::chrono::seconds kMoment{1};
    static constexpr std::size_t kEvents = 32;

    bool take() {
        const auto status = read_number();
        if (!status) return false;
        auto type = *status == kEvent ? std::string() : read_text();
        auto content = type ? read_text() : std::nullopt;
        if (!content) return false;
        const std::lock_guard lock(mutex_);
        if (*status == kEvent) {
            events_.push_back(std::make_shared<const std::string>(std::move(*content)));
            if (events_.size() > kEvents) {
                events_.pop_front();
                ++first_;
            }
        } else {
            answer_ = {static_cast<int>(*status), std::move(*type), std::move(*content),
                       first_ + events_.size()};
        }
        said_.notify_all();
        return true;
    }

    std::mutex turn_;
    std::mutex mutex_;
    std::condition_variable said_;
    std::optional<Answer> answer_;
    std::deque<std::shared_ptr<const std::string>> events_;
    std::uint64_t first_ = 0;  ///< number of the first of these
};

/// A thread for each connection, so that none waits for a slow one: programs that connect and say
/// nothing keep no page waiting.
class Connections final : public httplib::TaskQueue {
    /// void, or in later versions of the library whether the connection was taken.
    using Taken = decltype(std::declval<httplib::TaskQueue&>().enqueue(nullptr));

public:
    Taken enqueue(std::function<void()> connection) override {
        if (!start(connection)) connection();  // the others wait for it
        return static_cast<Taken>(true);
    }

    void shutdown() override {}

private:
    static bool start(const std::function<void()>& connection) {
        if (open_ >= kConnections) return false;
        try {
            std::thread([connection] {
                connection();
                --open_;
            }).detach();
        } catch (const std::system_error&) {
            return false;
        }
        ++open_;
        return true;
    }

    static inline std::atomic<int> open_ = 0;
};

/// Answers with events until the page goes: https://html.spec.whatwg.org, "Server-sent events".
void send_events(Etlc& etlc, const Etlc::Answer& begin, httplib::Response& response) {
    const auto number = std::make_shared<std::uint64_t>(begin.next_event);
    const auto first = std::make_shared<std::string>(begin.content);
    response.set_chunked_content_provider(
        "text/event-stream",
        [&etlc, number, first](std::size_t, httplib::DataSink& sink) {
            std::string text = ":\n\n";  // a comment shows whether the page is still there
            if (!first->empty())
                text = "data: " + std::exchange(*first, "") + "\n\n";
            else if (const auto event = etlc.event(*number))
                text = "data: " + *event + "\n\n";
            return sink.write(text.data(), text.size());
        },
        [&etlc](bool) { etlc.ask(kEnd, ""); });
}

void answer(Etlc& etlc, const std::string& path, const httplib::Request& request,
            httplib::Response& response) {
    const Etlc::Answer answer = etlc.ask(path, request.body);
    response.status = answer.status;
    if (path == "/events" && answer.status == kGood)
        send_events(etlc, answer, response);
    else
        response.set_content(answer.content, answer.type.c_str());
}

int serve() {
    const auto asked = read_number();
    const auto token = read_text();
    if (!asked || !token || token->size() != kTokenSize) return 1;
    httplib::Server server;
    server.set_payload_max_length(kMostContent);
    server.set_tcp_nodelay(true);
    server.set_keep_alive_max_count(kMostRequests);
    server.set_read_timeout(kReadSeconds);
    server.new_task_queue = [] { return new Connections; };
    server.set_default_headers({{"Cache-Control", "no-store"},
                                {"Referrer-Policy", "no-referrer"},
                                {"X-Content-Type-Options", "nosniff"},
                                {"X-Frame-Options", "DENY"},
                                {"Cross-Origin-Resource-Policy", "same-origin"}});
    // By default another program could listen to the same port.
    server.set_socket_options([](int socket) {
        const int yes = 1;
        ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    const int port = *asked == 0 ? server.bind_to_any_port(kHost)
                     : server.bind_to_port(kHost, static_cast<int>(*asked))
                         ? static_cast<int>(*asked)
                         : -1;
    if (port <= 0) {
        std::fprintf(stderr, "another program listens to port %u\n", *asked);
        return 1;
    }
    const Door door(*token, port);
    server.set_pre_routing_handler([&](const auto& request, auto& response) {
        if (door.path(request)) return httplib::Server::HandlerResponse::Unhandled;
        response.status = kForbidden;
        response.set_content("403: this address lacks the token that etlc printed\n",
                             "text/plain; charset=utf-8");
        return httplib::Server::HandlerResponse::Handled;
    });
    Etlc etlc;
    const auto pass = [&](const httplib::Request& request, httplib::Response& response) {
        const auto path = door.path(request);
        if (path && *path != kEnd) answer(etlc, *path, request, response);
    };
    server.Get(".*", pass);
    server.Post(".*", pass);
    std::string head;
    etlc::recordings::frames::append(head, static_cast<std::uint32_t>(port));
    if (!write_all(head)) return 1;
    etlc.listen();
    ::_exit(server.listen_after_bind() ? 0 : 1);  // connections may still use what is here
}

}  // namespace

int main() {
    try {
        return serve();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
