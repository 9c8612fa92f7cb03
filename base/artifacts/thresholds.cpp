#include "artifacts/thresholds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <type_traits>

#include "artifacts/file.hpp"
#include "data/files/hash.hpp"
#include "data/text/text.hpp"

namespace etlc::thresholds {
namespace {

using artifacts::Presence;
using diag::Code;

const artifacts::Kind kKind{"",
                            "etlc calibrate",
                            kFormat,
                            Code::malformed_thresholds,
                            Code::unknown_thresholds_format,
                            Code::invalid_thresholds,
                            Code::unreadable_thresholds};

/// Describes alpha or beta.
template <class Archive>
void rate_member(Archive& archive, const std::string& key, auto& rate, bool required,
                 const std::string& expected) {
    archive(key, rate, artifacts::Decimal{required, expected});
    if constexpr (Archive::kReads) {
        const double number = data::parse_number(rate).value_or(0);
        const bool sound = number > 0 && number < 1 && expected.starts_with("a number");
        if ((required || !rate.empty()) && !sound) archive.refuse(key, expected);
    }
}

/// Describes the scores of a threshold or duration.
template <class Archive>
void score_members(Archive& archive, auto& side, const std::string& method, bool of_two) {
    archive("n", side.n);
    archive("k", side.k);
    if constexpr (Archive::kReads) {
        const bool ranked = method != "f1" && method != "risk";
        if (ranked != (side.k > 0))
            archive.refuse("k", ranked ? "a rank from 1" : "0 for " + method);
        if (side.k > side.n + (of_two ? 1 : 0))
            archive.refuse("k", fmt::format("at most n{}, which is {}", of_two ? " + 1" : "",
                                            side.n + (of_two ? 1 : 0)));
    }
    archive("scores", side.scores);
    archive("losses", side.losses, Presence::where_any);
    archive("losses_before", side.losses_before, Presence::where_any);
}

/// Describes a threshold and its scores; one of two may be infinite.
template <class Archive>
void side_members(Archive& archive, auto& side, const std::string& method, bool of_two) {
    archive("epsilon", side.epsilon, artifacts::OrInfinite{of_two});
    score_members(archive, side, method, of_two);
}

/// Describes a duration and its scores.
template <class Archive>
void duration_members(Archive& archive, auto& entry) {
    std::uint64_t steps = entry.duration.value_or(0);
    archive("duration", steps);
    if constexpr (Archive::kReads) {
        entry.duration = steps;
        for (const char* const other : {"epsilon", "beta", "inner", "against", "within"})
            if (archive.find(other) != nullptr)
                archive.refuse(other, "no such key beside 'duration'");
    }
    score_members(archive, entry, entry.method, false);
    archive("reads", entry.reads, Presence::always);
    archive("episodes", entry.episodes, Presence::always);
}

template <class Archive>
void members(Archive& archive, auto& entry, bool of_monitor) {
    archive(
        "method", entry.method,
        artifacts::Words{{"f1", "conformal", "class_conditional", "adaptive", "risk", "normal"}});
    const bool rated = entry.method != "f1";
    rate_member(archive, "alpha", entry.alpha, rated,
                rated ? "a number between 0 and 1" : "no such key for f1");
    bool is_duration = entry.duration.has_value();
    if constexpr (Archive::kReads) is_duration = archive.find("duration") != nullptr;
    if (of_monitor && is_duration) return duration_members(archive, entry);
    if constexpr (std::is_same_v<Archive, artifacts::Keys>)
        if (of_monitor) archive("duration");
    rate_member(archive, "beta", entry.beta, false, "a number between 0 and 1");
    bool of_two = entry.inner.has_value();
    if constexpr (Archive::kReads) of_two = archive.find("inner") != nullptr;
    side_members(archive, entry, entry.method, of_two);
    archive("inner", entry.inner,
            [&](auto& one, auto& side) { side_members(one, side, entry.method, true); });
    archive("reads", entry.reads, Presence::always);
    if (of_monitor)
        archive("against", entry.against,
                artifacts::Words{{"missed_alarm", "missed_success", "both"}});
    else
        archive("against", entry.against, artifacts::Words{{"false_positives", "both"}},
                Presence::where_any);
    archive("within", entry.within, Presence::where_any);
    archive("measured", entry.measured, Presence::where_any);
    if (of_monitor) archive("episodes", entry.episodes, Presence::always);
    if constexpr (Archive::kReads)
        if (of_two != (entry.against == "both"))
            archive.refuse("against", of_two ? "'both', since there is an inner threshold"
                                             : "an inner threshold");
}

template <class Archive>
void file_members(Archive& archive, auto& file) {
    const auto entries = [](bool of_monitors) {
        return [of_monitors](auto& one, const std::string&, auto& entry) {
            members(one, entry, of_monitors);
        };
    };
    archive("spec", file.spec);
    archive("predicates", file.predicates, entries(false));
    archive("monitors", file.monitors, entries(true));
    archive("episodes", file.episodes, Presence::always);
    archive("recordings", file.recordings, Presence::where_any);
    artifacts::group_members(archive, file.groups);
    artifacts::allowance_members(archive, file.allowances);
    archive("etlc", file.etlc);
}

diag::Result<File> read_from(data::ByteSource& source, const std::string& path) {
    File file;
    file.path = path;
    const auto failure = artifacts::read_text(kKind, source, [&](artifacts::Reader& root) {
        root.read_file([&](auto& archive) { file_members(archive, file); });
    });
    if (failure) return *failure;
    return file;
}

}  // namespace

std::vector<std::uint64_t> all_episodes(const File& file) {
    std::vector<std::uint64_t> result = file.episodes;
    for (const auto& [name, entry] : file.monitors)
        result.insert(result.end(), entry.episodes.begin(), entry.episodes.end());
    return result;
}

void drop_unused_recordings(File& file) {
    std::vector<std::uint64_t> used = all_episodes(file);
    std::sort(used.begin(), used.end());
    file.recordings.keep(used);
    std::erase_if(file.groups, [&](const auto& group) {
        const auto hash = data::hash_of_text(group.first);
        return !hash || !std::binary_search(used.begin(), used.end(), *hash);
    });
}

GroupCount count_groups(const std::vector<std::uint64_t>& episodes, const GroupNames& names) {
    GroupCount result;
    if (names.empty()) return {false, episodes.size()};
    std::set<std::string> different;
    for (const std::uint64_t episode : episodes) {
        const auto found = names.find(data::hash_text(episode));
        result.any_named |= found != names.end();
        if (found == names.end() || different.insert(found->second).second) ++result.groups;
    }
    return result;
}

std::string text(const Allowance& allowance) {
    std::string what;
    if (allowance.overlapping > 0)
        what += fmt::format("{} that share{} most of {} content with another",
                            diag::counted(allowance.overlapping, "episode"),
                            allowance.overlapping == 1 ? "s" : "",
                            allowance.overlapping == 1 ? "its" : "their");
    if (allowance.leaked > 0)
        what += fmt::format("{}{} with a target among the frames", what.empty() ? "" : " and ",
                            diag::counted(allowance.leaked, "episode"));
    return fmt::format("--allow-overlap passed over {}: {}", what, allowance.reason);
}

diag::Result<File> read(const std::string& path) {
    const auto source = data::open_file(path, data::Streams::taken);
    if (!source) return diag::Failure{Code::unreadable_thresholds, source.failure().message};
    return read_from(**source, path);
}

diag::Result<File> parse(const std::string& json, const std::string& path) {
    return read_from(*data::from_memory(json), path);
}

bool write(const File& file, const std::function<bool(std::string_view)>& take) {
    return artifacts::write_file(take, kFormat, nullptr,
                                 [&](auto& archive) { file_members(archive, file); });
}

std::string write(const File& file) {
    return artifacts::file_text(kFormat, nullptr,
                                [&](auto& archive) { file_members(archive, file); });
}

}  // namespace etlc::thresholds
