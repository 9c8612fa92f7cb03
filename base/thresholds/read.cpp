#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "data/files/bytes.hpp"
#include "data/files/hash.hpp"
#include "data/text/number.hpp"
#include "data/text/quote.hpp"
#include "thresholds/items.hpp"
#include "thresholds/thresholds.hpp"

namespace etlc::thresholds {
namespace {

using data::in_quotes;
using diag::Code;
using diag::Failure;

/// Tree to File.
class Reader : private Fields {
public:
    explicit Reader(Items& items)
        : Fields(Code::invalid_thresholds, Code::unknown_thresholds_format), items_(items) {}

    diag::Result<File> read(const Json& root, const std::string& path) {
        File file;
        file.path = path;
        if (root.kind != Json::Kind::object) {
            fail("", root, "an object");
            return *failure_;
        }
        file.format = format(root, kFormat);
        check_keys(root, "",
                   {"format", "spec", "predicates", "monitors", "episodes", "recordings",
                    "allowances", "etlc"});
        file.spec = text(root, "", "spec");
        file.etlc = text(root, "", "etlc");
        entries(root, "predicates", "predicate", file.predicates);
        if (root.find("monitors") != nullptr) entries(root, "monitors", "formula", file.monitors);
        if (root.find("episodes") != nullptr) file.episodes = episodes(root, "", items_);
        if (root.find("recordings") != nullptr) file.recordings = recordings(root, items_);
        if (root.find("allowances") != nullptr) file.allowances = allowances(root);
        if (failure_) return *failure_;
        return file;
    }

private:
    /// `what` is the key of the canonical text: "predicate" or "formula".
    void entries(const Json& root, const std::string& key, const std::string& what,
                 std::map<std::string, Entry>& result) {
        const Json* object = member(root, "", key, Json::Kind::object, "an object");
        for (std::size_t i = 0; object != nullptr && i < object->keys.size() && !failure_; ++i) {
            const std::string& name = object->keys[i];
            result.emplace(name, entry(object->items[i], fmt::format("{}.{}", key, name), what));
        }
    }

    Entry entry(const Json& json, const std::string& path, const std::string& what) {
        Entry result;
        if (json.kind != Json::Kind::object) {
            fail(path, json, "an object");
            return result;
        }
        result.method = method(json, path);
        const bool ranked = result.method != "f1";
        const bool of_monitor = what == "formula";
        std::vector<std::string> keys{"method", "alpha", "epsilon", "n",       "k",
                                      "scores", what,    "truth",   "targets", "reads"};
        if (of_monitor) keys.insert(keys.end(), {"against", "episodes"});
        check_keys(json, path, keys);
        if (ranked || json.find("alpha") != nullptr) result.alpha = alpha(json, path, ranked);
        result.epsilon = epsilon(json, path);
        result.n = count(json, path, "n");
        result.k = count(json, path, "k");
        if (!failure_ && ranked != (result.k > 0))
            fail(path + ".k", *json.find("k"), ranked ? "a rank from 1" : "0 for f1");
        if (result.k > result.n)
            fail(path + ".k", *json.find("k"), fmt::format("at most n, which is {}", result.n));
        result.scores = scores(json, path);
        result.predicate = text(json, path, what);
        result.truth = text(json, path, "truth");
        result.targets = targets(json, path);
        result.reads = texts(json, path, "reads");
        if (!of_monitor) return result;
        result.against = against(json, path);
        result.episodes = episodes(json, path, items_);
        return result;
    }

    std::string method(const Json& json, const std::string& path) {
        std::string value = text(json, path, "method");
        const bool known = value == "f1" || value == "conformal" || value == "class_conditional" ||
                           value == "adaptive";
        if (!failure_ && !known)
            fail(path + ".method", *json.find("method"),
                 "'f1', 'conformal', 'class_conditional' or 'adaptive'");
        return value;
    }

    std::string alpha(const Json& json, const std::string& path, bool ranked) {
        const std::string expected = ranked ? "a number between 0 and 1" : "no such key for f1";
        const Json* value = member(json, path, "alpha", Json::Kind::number, expected);
        if (value == nullptr) return {};
        const double number = data::parse_number(value->text).value_or(0);
        if (!ranked || !(number > 0 && number < 1)) fail(path + ".alpha", *value, expected);
        return value->text;
    }

    float epsilon(const Json& json, const std::string& path) {
        const std::string expected = "a finite float32";
        const Json* value = member(json, path, "epsilon", Json::Kind::number, expected);
        if (value == nullptr) return 0;
        float result = 0;
        const std::string& digits = value->text;
        const auto [end, error] =
            std::from_chars(digits.data(), digits.data() + digits.size(), result);
        if (error != std::errc() || end != digits.data() + digits.size())
            fail(path + ".epsilon", *value, expected);
        return result;
    }

    std::vector<double> scores(const Json& json, const std::string& path) {
        member(json, path, "scores", Json::Kind::array, "an array of numbers");
        if (failure_) return {};
        auto found = items_.scores(path + ".scores");
        failure_ = std::move(found.failure);
        return std::move(found.values);
    }

    std::map<std::string, std::string> targets(const Json& json, const std::string& path) {
        const Json* object = member(json, path, "targets", Json::Kind::object, "an object");
        std::map<std::string, std::string> result;
        for (std::size_t i = 0; object != nullptr && i < object->keys.size() && !failure_; ++i)
            result[object->keys[i]] = data::hash_text(
                hash(object->items[i], fmt::format("{}.targets.{}", path, object->keys[i])));
        return result;
    }

    std::string against(const Json& json, const std::string& path) {
        std::string value = text(json, path, "against");
        if (!failure_ && value != "missed_alarm" && value != "missed_success")
            fail(path + ".against", *json.find("against"), "'missed_alarm' or 'missed_success'");
        return value;
    }

    Items& items_;
};

diag::Result<File> read_all(data::ByteSource& source, const std::string& path) {
    if (source.size() > kMaxFileBytes)
        return Failure{
            Code::unreadable_thresholds,
            fmt::format("is larger than {} bytes, the most that is read", kMaxFileBytes)};
    Text text(source, kMaxKeptBytes, Code::unreadable_thresholds);
    Items items(Code::invalid_thresholds);
    const auto root = parse_json(text, kMaxValues, Code::malformed_thresholds,
                                 Code::invalid_thresholds, items.takers());
    if (const auto twice = items.twice()) return *twice;
    if (!root) return root.failure();
    return Reader(items).read(*root, path);
}

diag::Result<File> read_from(data::ByteSource& source, const std::string& path) {
    try {
        return read_all(source, path);
    } catch (const data::SpillError& error) {
        return Failure{Code::unreadable_thresholds, error.what()};
    }
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
    if (!source) return Failure{Code::unreadable_thresholds, source.failure().message};
    return read_from(**source, path);
}

diag::Result<File> parse(const std::string& json, const std::string& path) {
    return read_from(*data::from_memory(json), path);
}

}  // namespace etlc::thresholds
