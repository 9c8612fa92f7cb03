#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "data/text/number.hpp"
#include "data/text/quote.hpp"
#include "data/traces/csv.hpp"
#include "data/traces/trace_formats.hpp"

namespace etlc::data {
namespace {

using diag::Code;
using diag::Failure;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kCandidates =
    1000;  ///< for a suggested name: an edit distance is computed to each

/// A column of the file and the element of a channel that it feeds.
struct Slot {
    std::size_t column = 0;
    std::size_t channel = 0;
    std::size_t element = 0;
};

std::string column_name(const Channel& channel, std::size_t element) {
    return channel.kind == Channel::Kind::vector ? fmt::format("{}[{}]", channel.name, element)
                                                 : channel.name;
}

/// The columns of a header by name, with the number of columns of each name.
class Header {
public:
    explicit Header(const CsvReader& row) {
        for (std::size_t i = 0; i < row.cells(); ++i) {
            names_.emplace_back(row.cell(i));
            auto& entry = columns_[names_.back()];
            entry.column = entry.count == 0 ? i : entry.column;
            ++entry.count;
        }
    }

    /// Returns the columns of all elements of all channels, in their order in the file.
    diag::Result<std::vector<Slot>> slots(const std::vector<Channel>& channels) const {
        std::vector<Slot> result;
        for (std::size_t c = 0; c < channels.size(); ++c) {
            if (channels[c].optional && !columns_.contains(column_name(channels[c], 0))) continue;
            for (std::size_t e = 0; e < channels[c].width; ++e) {
                const std::string name = column_name(channels[c], e);
                const auto found = columns_.find(name);
                if (found == columns_.end()) return absent(name, channels[c]);
                if (found->second.count > 1 && are_times(channels[c])) continue;
                if (found->second.count > 1)
                    return Failure{Code::no_such_channel,
                                   fmt::format("{} columns are named {}", found->second.count,
                                               in_quotes(name)),
                                   1, 1};
                result.push_back({found->second.column, c, e});
            }
            if (auto failure = beyond(channels[c])) return *failure;
        }
        std::sort(result.begin(), result.end(),
                  [](const Slot& a, const Slot& b) { return a.column < b.column; });
        return result;
    }

private:
    struct Entry {
        std::size_t column = 0;
        std::size_t count = 0;
    };

    Failure absent(const std::string& name, const Channel& channel) const {
        std::string message = fmt::format("no column {}", in_quotes(name));
        const bool vector = channel.kind == Channel::Kind::vector;
        if (vector)
            message +=
                fmt::format(", needed by input '{}' of {} elements", channel.name, channel.width);
        std::vector<std::string> candidates = names_;
        candidates.resize(std::min(candidates.size(), kCandidates));
        // z[15] is no misspelling of z[16]: a shorter vector gets no suggestion.
        const bool shorter = vector && columns_.contains(column_name(channel, 0));
        const std::string meant = shorter ? "" : suggestion(name, candidates);
        message += meant.empty() ? "; there are " + listed(names_) : meant;
        return {Code::no_such_channel, message, 1, 1};
    }

    /// Refuses a column beyond the width of a vector: the file was made for another width.
    std::optional<Failure> beyond(const Channel& channel) const {
        if (channel.kind != Channel::Kind::vector) return {};
        const std::string next = column_name(channel, channel.width);
        if (!columns_.contains(next)) return {};
        return Failure{Code::trace_shape,
                       fmt::format("has a column {}, but input '{}' has {} elements",
                                   in_quotes(next), channel.name, channel.width),
                       1, 1};
    }

    std::vector<std::string> names_;
    std::map<std::string, Entry> columns_;
};

/// Parses bools as programs write them: Python and pandas True, others true or TRUE.
std::optional<double> parse_bool(std::string_view text) {
    if (text == "True" || text == "true" || text == "TRUE") return 1;
    if (text == "False" || text == "false" || text == "FALSE") return 0;
    return {};
}

class CsvTrace final : public Trace {
public:
    CsvTrace(std::unique_ptr<CsvReader> rows, std::vector<Channel> channels,
             std::vector<Slot> slots, std::size_t columns)
        : rows_(std::move(rows)),
          channels_(std::move(channels)),
          slots_(std::move(slots)),
          columns_(columns) {
        has_.resize(channels_.size());
        for (const Slot& slot : slots_) has_[slot.channel] = true;
    }

    bool has(std::size_t channel) const override { return has_[channel]; }

    diag::Result<bool> next(Sample& sample) override {
        auto more = rows_->next();
        const std::uint32_t line = rows_->row_line();
        bool has_gap = false;
        while (more && *more && columns_ > 1 && rows_->cells() == 1 && rows_->empty()) {
            has_gap = true;
            more = rows_->next();
        }
        if (!more) return of_trace(more.failure());
        if (!*more) return false;
        if (has_gap)
            return Failure{Code::malformed_csv,
                           fmt::format("is an empty line before the last row; a step without "
                                       "samples has {} empty cells",
                                       columns_),
                           line, 1};
        if (rows_->cells() != columns_)
            return Failure{Code::malformed_csv, other_cells(rows_->cells(), columns_),
                           rows_->row_line(), 1};
        sample.values.resize(channels_.size());
        sample.present = has_;
        for (std::size_t c = 0; c < channels_.size(); ++c)
            sample.values[c].resize(channels_[c].width);
        for (const Slot& slot : slots_)
            if (auto failure = read_cell(slot, sample)) return *failure;
        for (std::size_t c = 0; c < channels_.size(); ++c)
            if (!sample.present[c]) sample.values[c].assign(channels_[c].width, kNaN);
        return true;
    }

private:
    std::optional<Failure> read_cell(const Slot& slot, Sample& sample) {
        if (rows_->empty(slot.column)) {
            sample.present[slot.channel] = false;
            return {};
        }
        const bool boolean = channels_[slot.channel].kind == Channel::Kind::boolean;
        const std::string_view cell = rows_->cell(slot.column);
        auto value = rows_->number(slot.column);
        if (!value && boolean) value = parse_bool(cell);
        if (!value && are_times(channels_[slot.channel])) {
            sample.present[slot.channel] = false;
            return {};
        }
        const bool sound =
            value && (!boolean || !std::isfinite(*value) || *value == 0 || *value == 1);
        if (!sound)
            return Failure{
                Code::not_a_number,
                fmt::format(
                    "column {} holds {}, expected {}",
                    in_quotes(column_name(channels_[slot.channel], slot.element)), in_quotes(cell),
                    boolean ? "0 or 1, True or False" : rows_->expected_number(slot.column)),
                rows_->line(slot.column), rows_->column(slot.column)};
        sample.values[slot.channel][slot.element] = std::isfinite(*value) ? *value : kNaN;
        return {};
    }

    std::unique_ptr<CsvReader> rows_;
    std::vector<Channel> channels_;
    std::vector<Slot> slots_;
    std::size_t columns_;
    std::vector<bool> has_;
};

}  // namespace

diag::Result<std::unique_ptr<Trace>> open_csv_trace(std::unique_ptr<ByteSource> source,
                                                    const std::vector<Channel>& channels) {
    auto rows = std::make_unique<CsvReader>(std::move(source));
    const auto header = rows->next();
    if (!header) return of_trace(header.failure());
    if (!*header)
        return Failure{Code::malformed_csv,
                       "is empty, expected a row with the names of the columns"};
    const std::size_t columns = rows->cells();
    auto slots = Header(*rows).slots(channels);
    if (!slots) return slots.failure();
    return std::unique_ptr<Trace>(
        std::make_unique<CsvTrace>(std::move(rows), channels, std::move(*slots), columns));
}

}  // namespace etlc::data
