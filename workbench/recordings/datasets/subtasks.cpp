#include "recordings/datasets/subtasks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "data/files/file.hpp"
#include "data/text/text.hpp"
#include "recordings/datasets/dataset.hpp"
#include "recordings/datasets/trace.hpp"
#include "recordings/parquet/table.hpp"

namespace etlc::recordings {

using namespace data;

namespace {

using diag::Code;
using diag::Failure;
using Cells = std::vector<Table::Cell>;

Failure inconsistent(const std::string& why) {
    return {Code::unreadable_dataset, why};
}

bool is_same(const Table::Cell& a, const Table::Cell& b) {
    const auto equal = [](double x, double y) {
        return x == y || (std::isnan(x) && std::isnan(y));
    };
    return a.texts == b.texts && std::equal(a.numbers.begin(), a.numbers.end(), b.numbers.begin(),
                                            b.numbers.end(), equal);
}

class SubtaskReader {
public:
    SubtaskReader(const Dataset& set, const DatasetEpisode& episode)
        : set_(set), episode_(episode) {}

    /// Reads all sources, or one.
    std::optional<Failure> read(std::string_view word) {
        const auto is_asked = [&](std::string_view one) {
            return word == kSubtaskWords[0] || word == one;
        };
        if (is_asked("language_persistent") && has("language_persistent"))
            if (auto failure = read_language()) return failure;
        if (is_asked("subtask_index") && has("subtask_index"))
            if (auto failure = read_indices()) return failure;
        const auto files =
            paths_matching(literal(set_.folder() + "/") + "meta/episodes/*/*.parquet");
        for (const std::string& file : files.value_or(std::vector<std::string>{}))
            for (const char* kind : {"sparse_subtask", "dense_subtask"})
                if (is_asked(kind))
                    if (auto failure = read_ranges(file.substr(set_.folder().size() + 1), kind))
                        return failure;
        return std::nullopt;
    }

    /// Returns the sources that the episode has.
    std::vector<Subtasks> take() { return std::move(found_); }

private:
    /// Reads the cells of the episode's rows in a file, or of all its rows. Fails where a column is
    /// there and not of text, or of numbers; one that is null throughout may have any type.
    template <class Take>
    std::optional<Failure> for_each_row(const std::string& file,
                                        const std::vector<std::string>& texts,
                                        const std::vector<std::string>& numbers, bool is_of_episode,
                                        const Take& take) {
        std::vector<std::string> names = texts;
        names.insert(names.end(), numbers.begin(), numbers.end());
        auto table = Table::open(set_.path_of(file), names, is_of_episode ? "episode_index" : "",
                                 episode_.index);
        if (!table) return in_part(file, table.failure());
        Cells cells;
        for (std::uint64_t row = 0;; ++row) {
            const auto more = (*table)->next(cells);
            if (!more) return in_part(file, more.failure());
            if (!*more) return std::nullopt;
            for (std::size_t i = 0; i < names.size(); ++i) {
                Table::Cell& cell = cells[i];
                const bool is_text = (*table)->columns()[i].is_text;
                const bool is_null =
                    cell.is_null ||
                    (!is_text && std::all_of(cell.numbers.begin(), cell.numbers.end(),
                                             [](double x) { return std::isnan(x); }));
                if (is_text != (i < texts.size()) && !is_null)
                    return in_part(file, inconsistent(fmt::format("column {} does not hold {}",
                                                                  in_quotes(names[i]),
                                                                  is_text ? "numbers" : "text")));
                if (!is_text && i < texts.size()) cell.texts.resize(cell.numbers.size());
            }
            if (auto failure = take(row, cells)) return in_part(file, *failure);
        }
    }

    bool has(const char* column) const {
        return std::any_of(set_.features().begin(), set_.features().end(),
                           [&](const Feature& feature) { return feature.name == column; });
    }

    /// Every row has the same list: of each of its entries a style, a content, and the time from
    /// which it is active, until the next of its style. LeRobot compares times as float32.
    std::optional<Failure> read_language() {
        Subtasks result{"language_persistent", {}, {}};
        std::map<float, std::int32_t> starts;
        Cells first;
        const auto take = [&](std::uint64_t row, const Cells& cells) -> std::optional<Failure> {
            if (row == 0) {
                first = cells;
                if (auto failure = read_entries(cells, starts, result.names)) return failure;
            }
            for (std::size_t i = 0; i < 3; ++i)
                if (!is_same(cells[i], first[i]))
                    return inconsistent(fmt::format(
                        "row {} of the episode has another list language_persistent than its first "
                        "row, expected the same list in every row",
                        row));
            const double time =
                cells[3].is_null ? static_cast<double>(row) / set_.fps() : cells[3].numbers[0];
            const auto next = starts.upper_bound(static_cast<float>(time));
            result.of_row.push_back(next == starts.begin() ? Subtasks::kNone
                                                           : std::prev(next)->second);
            return std::nullopt;
        };
        auto failure = for_each_row(episode_.rows,
                                    {"language_persistent.style", "language_persistent.content"},
                                    {"language_persistent.timestamp", "timestamp"}, true, take);
        if (!failure && !starts.empty()) found_.push_back(std::move(result));
        return failure;
    }

    static std::optional<Failure> read_entries(const Cells& cells,
                                               std::map<float, std::int32_t>& starts,
                                               std::vector<std::string>& names) {
        const auto& styles = cells[0].texts;
        for (std::size_t i = 0; i < styles.size(); ++i) {
            if (styles[i] != "subtask") continue;
            const bool has_all = i < cells[1].texts.size() && i < cells[2].numbers.size();
            if (!has_all || std::isnan(cells[2].numbers[i]))
                return inconsistent(
                    fmt::format("entry {} of language_persistent is a subtask "
                                "without content and timestamp",
                                i));
            const std::string& name = cells[1].texts[i];
            const auto start = static_cast<float>(cells[2].numbers[i]);
            const std::int32_t place = name.empty() ? Subtasks::kNone : place_of(name, names);
            if (!starts.emplace(start, place).second)
                return inconsistent(
                    fmt::format("two subtasks of language_persistent begin at {:.6g} s, and which "
                                "of them counts is not defined",
                                start));
        }
        return std::nullopt;
    }

    static std::int32_t place_of(const std::string& name, std::vector<std::string>& names) {
        const auto place = std::find(names.begin(), names.end(), name) - names.begin();
        if (place == static_cast<std::ptrdiff_t>(names.size())) names.push_back(name);
        return static_cast<std::int32_t>(place);
    }

    std::optional<Failure> read_indices() {
        Subtasks result{"subtask_index", {}, {}};
        const std::string table = "meta/subtasks.parquet";
        const auto name = [&](std::uint64_t row, const Cells& cells) -> std::optional<Failure> {
            const Table::Cell& text = cells[cells[0].is_null ? 1 : 0];
            const Table::Cell& index = cells[2];
            if (text.is_null || text.texts[0].empty())
                return inconsistent(
                    fmt::format("has no name in row {}, expected a column 'subtask' of text", row));
            if (index.is_null || index.numbers[0] != static_cast<double>(row))
                return inconsistent(fmt::format(
                    "row {} has the subtask_index {}: some releases of LeRobot go by the row, "
                    "others by the index, so they must agree",
                    row, index.is_null ? "null" : fmt::format("{}", index.numbers[0])));
            result.names.push_back(text.texts[0]);
            return std::nullopt;
        };
        if (auto failure = for_each_row(table, {"subtask", "__index_level_0__"}, {"subtask_index"},
                                        false, name))
            return failure;
        const auto take = [&](std::uint64_t row, const Cells& cells) -> std::optional<Failure> {
            const double index = cells[0].is_null ? -1 : cells[0].numbers[0];
            if (index >= static_cast<double>(result.names.size()) || index != std::floor(index))
                return inconsistent(
                    fmt::format("row {} of the episode has the subtask_index {}, and {} lists {}",
                                row, index, table, diag::counted(result.names.size(), "subtask")));
            result.of_row.push_back(index < 0 ? Subtasks::kUnknown
                                              : static_cast<std::int32_t>(index));
            return std::nullopt;
        };
        auto failure = for_each_row(episode_.rows, {}, {"subtask_index"}, true, take);
        if (!failure) found_.push_back(std::move(result));
        return failure;
    }

    /// Reads the row of the episode, with names, first and last frames. Of two subtasks that share
    /// a frame, the first in the list counts, as in LeRobot. The columns of sparse subtasks may
    /// lack their prefix.
    std::optional<Failure> read_ranges(const std::string& file, const std::string& kind) {
        const std::string old = kind == "sparse_subtask" ? "subtask" : kind;
        const auto take = [&](std::uint64_t, const Cells& cells) -> std::optional<Failure> {
            const std::size_t at = cells[0].is_null ? 1 : 0;
            if (cells[at].is_null) return std::nullopt;
            return add_ranges(kind, cells[at].texts, cells[2 + 2 * at].numbers,
                              cells[3 + 2 * at].numbers);
        };
        return for_each_row(file, {kind + "_names", old + "_names"},
                            {kind + "_start_frames", kind + "_end_frames", old + "_start_frames",
                             old + "_end_frames"},
                            true, take);
    }

    std::optional<Failure> add_ranges(const std::string& kind,
                                      const std::vector<std::string>& names,
                                      const std::vector<double>& firsts,
                                      const std::vector<double>& lasts) {
        const auto fail = [&](const std::string& why) {
            return inconsistent(fmt::format("{} of episode {} {}", kind, episode_.index, why));
        };
        if (names.empty() && firsts.empty() && lasts.empty()) return std::nullopt;
        if (firsts.size() != names.size() || lasts.size() != names.size())
            return fail(
                fmt::format("has {}, {} first and {} last frames, expected as many, and "
                            "one at least",
                            diag::counted(names.size(), "name"), firsts.size(), lasts.size()));
        Subtasks result{kind, {}, std::vector<std::int32_t>(episode_.length, Subtasks::kNone)};
        for (std::size_t i = 0; i < names.size(); ++i) {
            const double first = firsts[i];
            const double last = lasts[i];
            if (!(first >= 0 && first <= last) || first != std::floor(first) ||
                last != std::floor(last) || names[i].empty())
                return fail(
                    fmt::format("has {} from frame {} to {}, expected a name and frames "
                                "from 0 in order",
                                in_quotes(names[i]), first, last));
            const std::int32_t place = place_of(names[i], result.names);
            const auto length = static_cast<double>(episode_.length);
            const auto end = static_cast<std::size_t>(std::min(last + 1, length));
            for (auto row = static_cast<std::size_t>(std::min(first, length)); row < end; ++row)
                if (result.of_row[row] == Subtasks::kNone) result.of_row[row] = place;
        }
        found_.push_back(std::move(result));
        return std::nullopt;
    }

    const Dataset& set_;
    const DatasetEpisode& episode_;
    std::vector<Subtasks> found_;
};

}  // namespace

diag::Result<Subtasks> read_subtasks(const std::string& path, std::string_view word) {
    const auto found = find_episode(path);
    if (!found) return found.failure();
    SubtaskReader reader(*found->set, *found->episode);
    if (auto failure = reader.read(word)) return *failure;
    std::vector<Subtasks> sources = reader.take();
    if (sources.empty()) return Subtasks{};
    if (sources.size() > 1)
        return Failure{
            Code::contradictory_labels,
            fmt::format("has subtasks in {0} and in {1}: say in the spec which of them counts, "
                        "'truth NAME = {1} == \"NAME\";'",
                        sources[0].source, sources[1].source)};
    if (sources[0].of_row.size() != found->episode->length)
        return inconsistent("has other rows than before: it has changed meanwhile");
    return std::move(sources[0]);
}

}  // namespace etlc::recordings
