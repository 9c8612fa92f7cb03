#include "evaluated.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <numeric>

#include "driver/commands/commands.hpp"
#include "parse/parse.hpp"

namespace etlc::tests {
namespace {

namespace fs = std::filesystem;

class Folder {
public:
    explicit Folder(const std::vector<std::string>& episodes)
        : path_(fs::path(testing::TempDir()) / fmt::format("etlc_evaluate_{}", ::getpid())) {
        fs::create_directories(path_);
        for (std::size_t i = 0; i < episodes.size(); ++i) {
            files.push_back((path_ / fmt::format("{:04}.csv", i)).string());
            std::ofstream(files.back()) << episodes[i];
        }
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() { fs::remove_all(path_); }

    std::vector<std::string> files;

private:
    fs::path path_;
};

std::optional<evaluate::Judgement> run(const std::string& spec,
                                       const std::vector<std::string>& episodes, unsigned jobs,
                                       const std::vector<episodes::Variant>& variants,
                                       diag::Sink& sink) {
    const Folder folder(episodes);
    const source::File file("t.etl", spec);
    driver::Request compiling;
    compiling.check.judged_lets = true;
    const auto compiled = compile(file, compiling.check, compiling, sink);
    if (!compiled) return std::nullopt;
    evaluate::Request request;
    request.episodes = folder.files;
    request.jobs = jobs;
    request.variants = variants;
    std::vector<std::size_t> all(episodes.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return evaluate::judge({{*compiled, std::nullopt, std::move(all)}}, request, sink);
}

}  // namespace

check::Model model_of(const std::string& spec) {
    diag::Sink sink;
    const source::File file("t.etl", spec);
    auto model = check::check(parse::parse(file, sink), file, {}, sink);
    EXPECT_TRUE(model) << spec;
    return std::move(*model);
}

evaluate::Judgement judged(const std::string& spec, const std::vector<std::string>& episodes,
                           unsigned jobs, const std::vector<episodes::Variant>& variants) {
    diag::Sink sink;
    auto result = run(spec, episodes, jobs, variants, sink);
    for (const diag::Diagnostic& finding : sink.sorted())
        EXPECT_EQ(finding.severity(), diag::Severity::warning) << finding.message;
    return result ? std::move(*result) : evaluate::Judgement{};
}

evaluate::Evaluation evaluated(const std::string& spec, const std::vector<std::string>& episodes,
                               unsigned jobs, const std::vector<episodes::Variant>& variants) {
    return evaluate::summarise(judged(spec, episodes, jobs, variants), jobs);
}

std::vector<std::string> mistakes(const std::string& spec,
                                  const std::vector<std::string>& episodes) {
    diag::Sink sink;
    EXPECT_FALSE(run(spec, episodes, 1, {}, sink));
    std::vector<std::string> messages;
    for (const diag::Diagnostic& finding : sink.sorted())
        messages.push_back(fs::path(finding.file).filename().string() + ": " + finding.message);
    return messages;
}

}  // namespace etlc::tests
