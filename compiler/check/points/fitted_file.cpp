#include "check/points/fitted_file.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "check/context/steps.hpp"
#include "check/guarantees/provenance.hpp"
#include "data/files/file.hpp"

namespace etlc::check {

namespace {

using diag::Code;

constexpr std::string_view kAgain = "fit again with 'etlc fit'";

/// What `etlc fit` has not made yet.
diag::Diagnostic& report_missing(Context& c, Span span, std::string message) {
    diag::Diagnostic found{Code::fitted_missing, std::move(message), span, {}, 0, 0, {}};
    found.is_allowed = c.options.allow_missing;
    c.lacks_data = c.lacks_data || found.is_allowed;
    return c.sink.report(std::move(found));
}

std::optional<fitted::File> read_file(Context& c, const Fitted& first) {
    if (c.options.fitted != nullptr) return *c.options.fitted;
    const bool is_default = c.options.fitted_path.empty();
    const std::string path =
        is_default ? fitted::default_path(c.file.path()) : c.options.fitted_path;
    std::error_code unknown;
    const bool exists = std::filesystem::exists(path, unknown) || unknown;
    if (!exists) {
        report_missing(c, first.span,
                       fmt::format("'{}' is fitted, and there is no file {}", first.name, path))
            .note("'etlc fit' makes one from labelled demonstrations; --fitted names another");
        return std::nullopt;
    }
    auto file = fitted::read(path);
    if (!file) {
        c.sink.report(data::in_file(file.failure(), path))
            .note(first.span, fmt::format("'{}' is fitted", first.name));
        return std::nullopt;
    }
    c.dependencies.insert(path);
    return std::move(*file);
}

void report_stale(Context& c, const Fitted& fitted, const std::vector<std::string>& differences) {
    if (differences.empty()) return;
    auto& error = c.report(
        Code::fitted_stale, fitted.span,
        fmt::format("'{}' in {} was fitted for something else", fitted.name, c.fitted_file->path));
    for (const std::string& difference : differences) error.note(difference);
    error.note(std::string(kAgain));
}

std::string difference(std::string_view what, std::string_view then, std::string_view now) {
    return fmt::format("{} was: {}; it is: {}", what, then, now);
}

}  // namespace

const fitted::Entry* fitted_entry(Context& c, Index index) {
    if (c.options.allow_unfitted) return nullptr;
    const Fitted& fitted = c.model.fitted[index];
    if (!c.fitted_is_read) c.fitted_file = read_file(c, fitted);
    c.fitted_is_read = true;
    if (!c.fitted_file) return nullptr;
    const auto found = c.fitted_file->entries.find(fitted.name);
    if (found == c.fitted_file->entries.end()) {
        report_missing(c, fitted.span,
                       fmt::format("{} has nothing for '{}'", c.fitted_file->path, fitted.name))
            .note(std::string(kAgain));
        return nullptr;
    }
    const fitted::Entry& entry = found->second;
    std::vector<std::string> differences;
    if (entry.declaration != fitted.declaration)
        differences.push_back(difference("the declaration", entry.declaration, fitted.declaration));
    else if (entry.rows != fitted.rows || entry.columns != fitted.columns)
        differences.push_back(difference("its shape",
                                         fmt::format("{} x {}", entry.rows, entry.columns),
                                         fmt::format("{} x {}", fitted.rows, fitted.columns)));
    report_stale(c, fitted, differences);
    return differences.empty() ? &entry : nullptr;
}

void check_fitted_entries(Context& c) {
    if (!c.fitted_file || c.sink.has_errors()) return;
    for (const Fitted& fitted : c.model.fitted) {
        const fitted::Entry& entry = c.fitted_file->entries.at(fitted.name);
        const FittedProvenance now = provenance(c.model, fitted);
        std::vector<std::string> differences;
        if (entry.of != now.of) differences.push_back(difference("the point", entry.of, now.of));
        if (stated(entry.truth) != now.truth)
            differences.push_back(difference("the truth", entry.truth, now.truth));
        if (differences.empty() && !entry.reads.empty())
            differences = check::differences(entry.reads, now.reads);
        report_stale(c, fitted, differences);
    }
    for (const thresholds::Allowance& allowance : c.fitted_file->allowances)
        c.model.reservations.push_back(thresholds::text(allowance));
}

}  // namespace etlc::check
