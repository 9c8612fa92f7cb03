// etlc-serve: passes requests of one page to `etlc label`, which answers them. It is a separate
// program, so that etlc links no library that listens to a network, and a fault there loses no
// label. It listens to the loopback alone, and refuses with 403 what lacks the token, comes from
// another origin, or was addressed to another name (DNS rebinding).
#include <httplib.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "label/server/protocol.hpp"

namespace {

using namespace etlc::label::protocol;
using etlc::data::frames::number_at;

constexpr const char* kHost = "127.0.0.1";
constexpr int kForbidden = 403;
constexpr std::size_t kConnections = 32;          ///< a browser opens six for a page
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

/// Ends with the process that answers, also while no request waits for it.
void end_with_etlc() {
    std::thread([] {
        pollfd input{STDIN_FILENO, 0, 0};
        while (::poll(&input, 1, -1) <= 0 || (input.revents & (POLLHUP | POLLERR)) == 0) {
        }
        ::_exit(0);
    }).detach();
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

/// Passes a request on, one at a time, and ends where nobody answers.
void answer(const std::string& path, const httplib::Request& request, httplib::Response& response) {
    static std::mutex turn;
    const std::lock_guard lock(turn);
    std::string asked;
    append(asked, path);
    append(asked, request.body);
    if (!write_all(asked)) ::_exit(0);
    const auto status = read_number();
    const auto type = read_text();
    const auto content = read_text();
    if (!status || !type || !content) ::_exit(0);
    response.status = static_cast<int>(*status);
    response.set_content(*content, type->c_str());
}

int serve() {
    const auto asked = read_number();
    const auto token = read_text();
    if (!asked || !token || token->size() != kTokenSize) return 1;
    httplib::Server server;
    server.set_payload_max_length(kMostContent);
    server.set_tcp_nodelay(true);
    server.set_keep_alive_max_count(kMostRequests);
    server.new_task_queue = [] { return new httplib::ThreadPool(kConnections); };
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
        response.set_content("403: this address lacks the token that etlc label printed\n",
                             "text/plain; charset=utf-8");
        return httplib::Server::HandlerResponse::Handled;
    });
    const auto pass = [&](const httplib::Request& request, httplib::Response& response) {
        if (const auto path = door.path(request)) answer(*path, request, response);
    };
    server.Get(".*", pass);
    server.Post(".*", pass);
    std::string head;
    etlc::data::frames::append(head, static_cast<std::uint32_t>(port));
    if (!write_all(head)) return 1;
    end_with_etlc();
    return server.listen_after_bind() ? 0 : 1;
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
