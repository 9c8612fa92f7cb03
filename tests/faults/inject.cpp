// A library to preload that makes system calls of a program fail on demand. It reads
// ETLC_INJECT=CALL:FIRST:COUNT:ACTION from the environment. CALL is one of kCalls; its calls number
// FIRST (from 1) to FIRST + COUNT - 1 after the beginning of main() get ACTION: an error number, or
// `short` (only half of the bytes are written). ETLC_INJECT_COUNTS names a file that receives, at
// the end of main(), the number of calls of each kind.
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

enum Call {
    kMalloc,
    kWrite,
    kOpen,
    kClose,
    kLink,
    kRename,
    kDup,
    kLock,
    kChange,
    kThread,
    kSpawn,
    kPipe,
    kCalls
};
constexpr const char* kNames[kCalls] = {"malloc", "write", "open",   "close",  "link",  "rename",
                                        "dup",    "lock",  "change", "thread", "spawn", "pipe"};

enum class Action { none, fail, halve };

struct Injection {
    int call = kCalls;
    long first = 0;
    long count = 0;
    Action action = Action::none;
    int error = 0;
};

Injection injection;
std::atomic<bool> armed{false};
std::atomic<long> calls[kCalls];

/// Returns the action for the next call of this kind.
Action next(Call call) {
    if (!armed) return Action::none;
    const long n = ++calls[call];
    const bool hit =
        call == injection.call && n >= injection.first && n < injection.first + injection.count;
    if (!hit) return Action::none;
    if (injection.action == Action::fail) errno = injection.error;
    return injection.action;
}

template <class Function>
Function* real(const char* name) {
    return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

void read_wish() {
    const char* const wish = std::getenv("ETLC_INJECT");
    char call[16];
    char action[16];
    if (wish == nullptr || std::sscanf(wish, "%15[^:]:%ld:%ld:%15s", call, &injection.first,
                                       &injection.count, action) != 4)
        return;
    injection.call = static_cast<int>(
        std::find_if(kNames, kNames + kCalls,
                     [&](const char* name) { return std::strcmp(name, call) == 0; }) -
        kNames);
    injection.error = std::atoi(action);
    injection.action = std::strcmp(action, "short") == 0 ? Action::halve : Action::fail;
}

void write_counts() {
    const char* const path = std::getenv("ETLC_INJECT_COUNTS");
    if (path == nullptr) return;
    std::FILE* const file = std::fopen(path, "w");
    if (file == nullptr) return;
    for (int call = 0; call < kCalls; ++call)
        std::fprintf(file, "%s %ld\n", kNames[call], calls[call].load());
    std::fclose(file);
}

int (*program)(int, char**, char**);

int armed_main(int argc, char** argv, char** environment) {
    read_wish();
    armed = true;
    const int status = program(argc, argv, environment);
    armed = false;
    write_counts();
    return status;
}

}  // namespace

// The exported functions have the names and types of the C library's functions and forward to them.
extern "C" {

void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);

int __libc_start_main(int (*main)(int, char**, char**), int argc, char** argv, void (*begin)(),
                      void (*end)(), void (*loader_end)(), void* stack_end) {
    program = main;
    return real<decltype(__libc_start_main)>("__libc_start_main")(armed_main, argc, argv, begin,
                                                                  end, loader_end, stack_end);
}

void* malloc(std::size_t n) {
    return next(kMalloc) == Action::fail ? nullptr : __libc_malloc(n);
}

void* calloc(std::size_t n, std::size_t size) {
    return next(kMalloc) == Action::fail ? nullptr : __libc_calloc(n, size);
}

void* realloc(void* old, std::size_t n) {
    return next(kMalloc) == Action::fail ? nullptr : __libc_realloc(old, n);
}

ssize_t write(int file, const void* bytes, std::size_t n) {
    const Action action = next(kWrite);
    if (action == Action::fail) return -1;
    if (action == Action::halve) n = std::max<std::size_t>(1, n / 2);
    return ::syscall(SYS_write, file, bytes, n);
}

int openat(int folder, const char* path, int flags, ...) {
    va_list rest;
    va_start(rest, flags);
    const mode_t mode = va_arg(rest, mode_t);
    va_end(rest);
    if (next(kOpen) == Action::fail) return -1;
    return static_cast<int>(::syscall(SYS_openat, folder, path, flags, mode));
}

int open(const char* path, int flags, ...) {
    va_list rest;
    va_start(rest, flags);
    const mode_t mode = va_arg(rest, mode_t);
    va_end(rest);
    return openat(AT_FDCWD, path, flags, mode);
}

std::FILE* fopen(const char* path, const char* mode) {
    return next(kOpen) == Action::fail ? nullptr : real<decltype(fopen)>("fopen")(path, mode);
}

int close(int file) {
    const Action action = next(kClose);
    const int result =
        static_cast<int>(::syscall(SYS_close, file));  // which is closed even after an error
    if (action != Action::fail) return result;
    errno = injection.error;
    return -1;
}

int linkat(int from_folder, const char* from, int folder, const char* to, int flags) {
    if (next(kLink) == Action::fail) return -1;
    return static_cast<int>(::syscall(SYS_linkat, from_folder, from, folder, to, flags));
}

int renameat(int from_folder, const char* from, int folder, const char* to) {
    if (next(kRename) == Action::fail) return -1;
    return static_cast<int>(::syscall(SYS_renameat, from_folder, from, folder, to));
}

int fcntl(int file, int command, ...) {
    va_list rest;
    va_start(rest, command);
    const long argument = va_arg(rest, long);
    va_end(rest);
    if (command == F_DUPFD_CLOEXEC && next(kDup) == Action::fail) return -1;
    return static_cast<int>(::syscall(SYS_fcntl, file, command, argument));
}

int lock_file(int file,
              int operation) __asm__("flock");  // also the name of a class in <fcntl.h>
int lock_file(int file, int operation) {
    return next(kLock) == Action::fail ? -1
                                       : static_cast<int>(::syscall(SYS_flock, file, operation));
}

int fchmod(int file, mode_t mode) {
    return next(kChange) == Action::fail ? -1 : static_cast<int>(::syscall(SYS_fchmod, file, mode));
}

int fchown(int file, uid_t owner, gid_t group) {
    return next(kChange) == Action::fail
               ? -1
               : static_cast<int>(::syscall(SYS_fchown, file, owner, group));
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
                   void* argument) {
    if (next(kThread) == Action::fail) return injection.error;
    return real<decltype(pthread_create)>("pthread_create")(thread, attributes, start, argument);
}

int posix_spawn(pid_t* process, const char* path, const posix_spawn_file_actions_t* actions,
                const posix_spawnattr_t* attributes, char* const argv[],
                char* const environment[]) {
    if (next(kSpawn) == Action::fail) return injection.error;
    return real<decltype(posix_spawn)>("posix_spawn")(process, path, actions, attributes, argv,
                                                      environment);
}

int pipe2(int ends[2], int flags) {
    return next(kPipe) == Action::fail ? -1 : static_cast<int>(::syscall(SYS_pipe2, ends, flags));
}

}  // extern "C"
