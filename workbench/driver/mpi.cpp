// etlc-mpi calibrate|evaluate ...: runs a call on all ranks of an MPI job.
// Takes: the arguments of `etlc`, which starts this program in a job of several ranks; also --parts
// FOLDER and --resume. Gives: the result of the call, byte for byte: each rank runs
// `etlc ... --shard -/N` and assigns it one shard after the other, then the first rank runs
// `etlc merge`. Keeps true: finished shards survive the job; --resume runs only the others.
#include <fcntl.h>
#include <mpi.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace {

namespace fs = std::filesystem;

/// More shards than ranks, so that fast ranks take over work from slow ones.
constexpr int kShardsPerRank = 16;

struct Job {
    std::vector<std::string> call;  ///< the arguments, from the command on
    std::string parts = "etlc.parts";
    bool resumes = false;
    bool has_jobs = false;  ///< whether the call has --jobs
    int rank = 0;
    int shards = 0;
};

/// Parses the arguments; returns an error or "".
std::string read_arguments(int argc, char** argv, Job& job) {
    constexpr std::string_view kParts = "--parts=";
    for (int i = 1; i < argc; ++i) {
        const std::string_view word = argv[i];
        if (word == "--resume") {
            job.resumes = true;
        } else if (word == "--parts") {
            if (++i == argc) return "--parts needs a folder";
            job.parts = argv[i];
        } else if (word.starts_with(kParts)) {
            job.parts = word.substr(kParts.size());
        } else {
            job.has_jobs = job.has_jobs || word.starts_with("-j") || word.starts_with("--jobs");
            job.call.emplace_back(word);
        }
    }
    return job.parts.empty() ? "--parts needs a folder" : "";
}

fs::path etlc_path() {
    std::error_code error;
    const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
    const fs::path beside = folder / "etlc";
    return fs::exists(beside, error) ? beside : folder.parent_path().parent_path() / "bin" / "etlc";
}

/// Starts etlc; descriptors that are not negative become its standard input and output. Reports an
/// error and returns 0 where that fails.
pid_t start_etlc(const std::vector<std::string>& arguments, int input, int output) {
    std::string program = etlc_path().string();
    std::vector<char*> words = {program.data()};
    std::vector<std::string> copies = arguments;
    for (std::string& copy : copies) words.push_back(copy.data());
    words.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    if (input >= 0) posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    if (output >= 0) posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    pid_t process = 0;
    const int error =
        posix_spawn(&process, program.c_str(), &actions, nullptr, words.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error == 0) return process;
    std::fprintf(stderr, "etlc-mpi: %s cannot be run: %s\n", program.c_str(), std::strerror(error));
    return 0;
}

/// Waits for a process and returns its exit status, or 128 + the signal that ended it.
int status_of(pid_t process) {
    if (process == 0) return 1;
    int status = 0;
    while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string part_path(const Job& job, int shard) {
    return (fs::path(job.parts) / (std::to_string(shard) + ".part")).string();
}

/// The file in which shards record how episodes are dealt out.
std::string contents_path(const Job& job) {
    return (fs::path(job.parts) / "contents").string();
}

/// An etlc process that makes one shard after the other.
class Maker {
public:
    explicit Maker(const Job& job) : job_(job) {}
    Maker(const Maker&) = delete;
    Maker& operator=(const Maker&) = delete;
    ~Maker() { finish(); }

    /// Makes a shard; returns 0 where its part exists.
    int make(int shard) {
        std::error_code error;
        if (fs::exists(part_path(job_, shard), error))
            return 0;  // made by the job that is resumed; files appear whole
        if (process_ == 0 && !start()) return 1;
        if (std::fprintf(to_, "%d\n", shard) > 0 && std::fflush(to_) == 0) {
            int made = 0;
            if (std::fscanf(from_, "%d", &made) == 1 && made == shard) return 0;
        }
        const int status = std::max(1, finish());
        std::fprintf(stderr,
                     "etlc-mpi: rank %d: shard %d/%d ended with status %d; --resume goes on\n",
                     job_.rank, shard, job_.shards, status);
        return status;
    }

    /// Returns the exit status; 0 where no process was started.
    int finish() {
        if (process_ == 0) return 0;
        std::fclose(to_);
        std::fclose(from_);
        return status_of(std::exchange(process_, 0));
    }

private:
    bool start() {
        std::vector<std::string> call = job_.call;
        call.insert(call.end(),
                    {"--shard", "-/" + std::to_string(job_.shards), "--part", job_.parts});
        if (!job_.has_jobs) call.insert(call.end(), {"--jobs", "1"});
        int numbers[2];
        int answers[2];
        if (::pipe2(numbers, O_CLOEXEC) != 0 || ::pipe2(answers, O_CLOEXEC) != 0) {
            std::fprintf(stderr, "etlc-mpi: no more files can be opened\n");
            return false;
        }
        process_ = start_etlc(call, numbers[0], answers[1]);
        ::close(numbers[0]);
        ::close(answers[1]);
        to_ = ::fdopen(numbers[1], "w");
        from_ = ::fdopen(answers[0], "r");
        return process_ != 0;
    }

    const Job& job_;
    pid_t process_ = 0;
    std::FILE* to_ = nullptr;
    std::FILE* from_ = nullptr;
};

/// Hands out 0, 1, 2, ... among the ranks.
class Counter {
public:
    Counter() {
        int rank = 0;
        MPI_Comm_rank(MPI_COMM_WORLD, &rank);
        const MPI_Aint size = rank == 0 ? sizeof(int) : 0;
        MPI_Win_allocate(size, sizeof(int), MPI_INFO_NULL, MPI_COMM_WORLD, &memory_, &window_);
        if (rank == 0) *memory_ = 0;
        MPI_Barrier(MPI_COMM_WORLD);
    }
    Counter(const Counter&) = delete;
    Counter& operator=(const Counter&) = delete;
    ~Counter() { MPI_Win_free(&window_); }

    /// Returns the count and adds `n` to it.
    int take(int n = 1) {
        int before = 0;
        MPI_Win_lock(MPI_LOCK_EXCLUSIVE, 0, 0, window_);
        MPI_Fetch_and_op(&n, &before, MPI_INT, 0, 0, MPI_SUM, window_);
        MPI_Win_unlock(0, window_);
        return before;
    }

private:
    int* memory_ = nullptr;
    MPI_Win window_{};
};

/// Makes all shards; returns the greatest exit status of all ranks.
int run_shards(const Job& job) {
    int worst = 0;
    {
        Counter counter;
        Maker maker(job);
        for (int next = counter.take(); next < job.shards; next = counter.take()) {
            worst = std::max(worst, maker.make(next + 1));
            if (worst != 0) counter.take(job.shards);  // no rank begins another
        }
        worst = std::max(worst, maker.finish());
        MPI_Barrier(MPI_COMM_WORLD);
    }
    int all = 0;
    MPI_Allreduce(&worst, &all, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    return all;
}

/// Makes the folder of parts, on the first rank; returns an exit status.
int make_folder(const Job& job) {
    std::error_code error;
    const bool is_new = fs::create_directories(job.parts, error);
    if (error) {
        std::fprintf(stderr, "etlc-mpi: %s: cannot be made: %s\n", job.parts.c_str(),
                     error.message().c_str());
        return 1;
    }
    if (is_new || job.resumes || fs::is_empty(job.parts, error)) return 0;
    std::fprintf(stderr,
                 "etlc-mpi: %s: holds parts of another job; expected --resume, which goes on with "
                 "them, or another folder, --parts FOLDER\n",
                 job.parts.c_str());
    return 2;
}

int merge(const Job& job) {
    std::vector<std::string> call = {"merge"};
    for (int shard = 1; shard <= job.shards; ++shard) call.push_back(part_path(job, shard));
    const int status = status_of(start_etlc(call, -1, -1));
    if (status != 0) return status;
    std::error_code error;
    for (std::size_t i = 1; i < call.size(); ++i) fs::remove(call[i], error);
    fs::remove(contents_path(job), error);
    fs::remove(job.parts, error);  // if nothing else is in it
    return 0;
}

int of_first_rank(int status) {
    MPI_Bcast(&status, 1, MPI_INT, 0, MPI_COMM_WORLD);
    return status;
}

int run(int argc, char** argv) {
    Job job;
    int ranks = 1;
    MPI_Comm_rank(MPI_COMM_WORLD, &job.rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    job.shards = kShardsPerRank * ranks;
    if (const std::string mistake = read_arguments(argc, argv, job); !mistake.empty()) {
        if (job.rank == 0) std::fprintf(stderr, "etlc-mpi: %s\n", mistake.c_str());
        return 2;
    }
    int status = of_first_rank(job.rank == 0 ? make_folder(job) : 0);
    ::setenv("ETLC_CONTENTS", contents_path(job).c_str(), 1);
    if (status == 0) status = run_shards(job);
    if (status == 0) status = of_first_rank(job.rank == 0 ? merge(job) : 0);
    return status;
}

}  // namespace

int main(int argc, char** argv) {
    ::setenv("ETLC_RANK", "1", 1);  // so that etlc does not start etlc-mpi again
    // Ranks exchange only a few numbers, so Open MPI need not search for a fast network, which
    // takes a fifth of a second; the user's setting wins.
    ::setenv("OMPI_MCA_pml", "ob1", 0);
    ::signal(SIGPIPE, SIG_IGN);  // sent where an etlc has ended
    MPI_Init(&argc, &argv);
    const int status = run(argc, argv);
    MPI_Finalize();
    return status;
}
