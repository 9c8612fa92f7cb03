#include "library/state_file.hpp"

#include <fmt/format.h>

#include <cstring>
#include <string_view>

#include "check/model/fingerprint.hpp"
#include "data/files/hash.hpp"
#include "library/version.hpp"

namespace etlc::library {

namespace {

/// The first byte is not text, so text conversions are detected; the last word is 1, in the byte
/// order of the machine.
struct Head {
    char magic[8] = {'\x89', 'E', 'T', 'L', 'S', 'T', 'A', '\n'};
    std::uint32_t order = 1;
    std::uint32_t format = 1;
    char version[32] = {};
    std::uint64_t spec = 0;
    std::uint64_t data = 0;
    std::uint64_t thresholds = 0;
    std::uint64_t plan = 0;  ///< hash of the printed plan, which the options of etlc_open() change
    std::uint64_t environments = 0;
    std::uint64_t history = 0;
};
static_assert(sizeof(Head) == 96, "there is no padding");

Head head_of(const Program& program, const StateOrigin& origin) {
    const check::Fingerprint made_from = check::fingerprint(program.model());
    Head head;
    std::strncpy(head.version, kVersion, sizeof head.version - 1);
    head.spec = made_from.spec;
    head.data = made_from.data;
    head.thresholds = made_from.thresholds;
    head.plan = data::xxh64(plan::print(program.plan()));
    head.environments = origin.environments;
    head.history = origin.history;
    return head;
}

std::string_view text_of_bytes(std::span<const std::uint8_t> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string kind_of(std::uint64_t environments) {
    return environments == 0 ? "one monitor" : fmt::format("a batch of {}", environments);
}

/// Says how the origin of bytes differs from what is expected.
std::string difference(const Program& program, const Head& found, const Head& expected) {
    const auto other = [&](const char* what) {
        return fmt::format("the state was saved with other {} than those of '{}' here", what,
                           program.model().name);
    };
    if (std::memcmp(found.version, expected.version, sizeof found.version) != 0)
        return fmt::format("the state was saved by etlc {}, this is {}", found.version,
                           expected.version);
    if (found.spec != expected.spec)
        return fmt::format(
            "the state was saved with another spec than '{}' here, or other settings",
            program.model().name);
    if (found.data != expected.data) return other("target sets or weights");
    if (found.thresholds != expected.thresholds) return other("thresholds");
    if (found.plan != expected.plan) return other("options (values, targets_as, lets, max_...)");
    if (found.environments != expected.environments)
        return fmt::format("the state is that of {}, expected that of {}",
                           kind_of(found.environments), kind_of(expected.environments));
    if (found.history != expected.history)
        return fmt::format("the state was saved with a history of {} steps, here it is {}",
                           found.history, expected.history);
    return "";
}

}  // namespace

void begin_state(const Program& program, const StateOrigin& origin,
                 std::vector<std::uint8_t>& bytes) {
    const Head head = head_of(program, origin);
    bytes.resize(sizeof head);
    std::memcpy(bytes.data(), &head, sizeof head);
}

void end_state(std::vector<std::uint8_t>& bytes) {
    const std::uint64_t sum = data::xxh64(text_of_bytes(bytes));
    const std::size_t size = bytes.size();
    bytes.resize(size + sizeof sum);
    std::memcpy(bytes.data() + size, &sum, sizeof sum);
}

std::string open_state(const Program& program, const StateOrigin& origin,
                       std::span<const std::uint8_t>& bytes) {
    const Head expected = head_of(program, origin);
    Head found;
    std::uint64_t sum = 0;
    const bool is_state = bytes.size() >= sizeof found.magic &&
                          std::memcmp(bytes.data(), expected.magic, sizeof expected.magic) == 0;
    if (!is_state) return "these are not the bytes of etlc_save()";
    if (bytes.size() < sizeof found + sizeof sum) return "the state is cut off";
    std::memcpy(&found, bytes.data(), sizeof found);
    if (found.order != expected.order) return "the state was saved on a machine of another kind";
    if (found.format != expected.format)
        return "the state was saved by another version of etlc, in another format";
    found.version[sizeof found.version - 1] = '\0';
    const auto content = bytes.first(bytes.size() - sizeof sum);
    std::memcpy(&sum, bytes.data() + content.size(), sizeof sum);
    if (sum != data::xxh64(text_of_bytes(content))) return "the state is cut off or damaged";
    bytes = content.subspan(sizeof found);
    return difference(program, found, expected);
}

}  // namespace etlc::library
