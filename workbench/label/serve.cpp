#include "label/serve.hpp"

#include <nlohmann/json.hpp>

#include <chrono>
#include <cstddef>
#include <utility>

#include "data/text/text.hpp"

namespace etlc::label {

namespace {

using Json = nlohmann::ordered_json;
using diag::Code;
using diag::Failure;

/// A page that has not asked for so long is closed. A page in the background asks once a minute,
/// because browsers slow its timers down; one that is closed says so.
constexpr std::chrono::seconds kGone{90};

Answer answered(const Json& json, std::uint32_t status = 200) {
    return {status, "application/json", json.dump(-1, ' ', false, Json::error_handler_t::replace)};
}

/// `kind`: "elsewhere", "changed", "disk" or "refused", which the page treats differently.
Answer refused(const std::string& kind, const std::string& why, std::uint32_t status) {
    return answered({{"kind", kind}, {"error", why}}, status);
}

Answer not_found(const std::string& why) {
    return {404, "text/plain; charset=utf-8", why};
}

/// Answers the requests of pages.
class Clerk {
public:
    Clerk(Desk& desk, Frames& frames, Background& background, const std::string& page)
        : desk_(desk), frames_(frames), background_(background), page_(page) {}

    Answer answer(const std::string& path, const std::string& content) {
        if (path == "/") return {200, "text/html; charset=utf-8", page_};
        if (path.starts_with("/frame/")) return frame(path.substr(7));
        if (path != "/state" && path != "/act") return not_found("there is nothing here");
        try {
            const Json asked = Json::parse(content);
            background_.look_after(desk_);
            return path == "/state" ? state(asked) : act_once(asked);
        } catch (const nlohmann::json::exception& error) {
            return refused("refused", error.what(), 400);
        }
    }

private:
    using Clock = std::chrono::steady_clock;

    /// `place`: "12/250", the episode and the step.
    Answer frame(const std::string& place) {
        const std::size_t slash = place.find('/');
        const auto episode = data::parse_whole<std::size_t>(place.substr(0, slash));
        const auto step = data::parse_whole<std::uint64_t>(
            slash == std::string::npos ? "" : place.substr(slash + 1));
        if (!episode || !step || *episode >= desk_.episodes().size() ||
            *step >= desk_.episodes()[*episode].steps)
            return not_found("there is no such step");
        auto image = frames_.at(desk_.episodes()[*episode], *step);
        if (!image) return not_found(image.failure().message);
        return {200, std::move(image->type), std::move(image->bytes)};
    }

    /// The page that asks may label if no other one does.
    bool takes(const std::string& page) {
        const auto now = Clock::now();
        if (holder_.empty() || now - heard_ > kGone) holder_ = page;
        if (holder_ != page) return false;
        heard_ = now;
        return true;
    }

    /// Returns what is newer than the versions that the page has.
    Answer state(const Json& asked) {
        Json result{{"holds", takes(asked.at("page"))},
                    {"version", desk_.version()},
                    {"proposed", background_.version()},
                    {"busy", background_.is_busy()},
                    {"changed", desk_.have_tables_changed()}};
        if (asked.at("version") != desk_.version()) {
            result["labels"] = Json::array();
            for (std::size_t e = 0; e < desk_.episodes().size(); ++e)
                result["labels"].push_back(labels_of(e));
        }
        if (asked.at("proposed") != background_.version()) {
            const Proposals& proposals = background_.proposals();
            result["why_none"] = proposals.why_none;
            result["proposals"] = Json::array();
            for (const Proposal& one : proposals.found) {
                Json marks = Json::array();
                for (const Marks& of : one.marks) marks.push_back(json_of(of));
                result["proposals"].push_back(
                    {{"episode", one.episode}, {"doubt", one.doubt}, {"marks", marks}});
            }
        }
        return answered(result);
    }

    Json labels_of(std::size_t episode) const {
        Json labels = Json::array();
        for (std::size_t p = 0; p < desk_.predicates().size(); ++p)
            labels.push_back(json_of(desk_.marks(episode, p)));
        return labels;
    }

    /// A page that did not get the answer to a key sends it again; it is done once.
    Answer act_once(const Json& asked) {
        const std::uint64_t number = asked.value("number", std::uint64_t{0});
        const std::pair<std::string, std::uint64_t> key{asked.at("page"), number};
        if (number > 0 && key == last_key_) return last_answer_;
        Answer answer = act(asked);
        if (answer.status == 200) {
            last_key_ = key;
            last_answer_ = answer;
        }
        return answer;
    }

    Answer act(const Json& asked) {
        const std::string page = asked.at("page");
        const std::string action = asked.at("action");
        if (action == "claim") holder_ = page;
        if (action == "release" && holder_ == page) holder_.clear();
        if (action == "release") return answered(Json::object());
        if (!takes(page))
            return refused("elsewhere", "this page is open elsewhere, too, and labels there", 409);
        if (action == "claim") return answered({{"version", desk_.version()}});
        if (action == "reload") {
            if (auto failure = desk_.reload()) return refused("changed", failure->message, 409);
            return answered({{"version", desk_.version()}});
        }
        if (action == "undo" || action == "redo") {
            const auto done = action == "undo" ? desk_.undo() : desk_.redo();
            if (!done) return not_written(done.failure());
            return changed(*done);
        }
        const std::size_t episode = asked.at("episode");
        if (episode >= desk_.episodes().size())
            return refused("refused", "there is no such episode", 400);
        if (action == "accept") return accept(episode, asked.at("marks"));
        const std::size_t p = asked.at("predicate");
        const std::uint64_t step = asked.at("step");
        const auto key = key_named(action);
        if (!key || p >= desk_.predicates().size() || step >= desk_.episodes()[episode].steps)
            return refused("refused", "there is no such key, predicate or step", 400);
        if (auto failure = desk_.press(episode, p, *key, step)) return not_written(*failure);
        return changed(episode);
    }

    /// Accepts what the page shows, since other labels may be proposed by now.
    Answer accept(std::size_t episode, const Json& shown) {
        std::vector<Marks> marks;
        for (const Json& one : shown) {
            auto of = marks_of(one, desk_.episodes()[episode].steps);
            if (!of) return refused("refused", "these are no labels of this episode", 400);
            marks.push_back(std::move(*of));
        }
        if (auto failure = desk_.accept(episode, marks)) return not_written(*failure);
        return changed(episode);
    }

    Answer changed(std::optional<std::size_t> episode) const {
        Json result{{"version", desk_.version()}};
        if (episode) result["episode"] = *episode;
        if (episode) result["labels"] = labels_of(*episode);
        return answered(result);
    }

    Answer not_written(const Failure& failure) const {
        if (failure.code == Code::contradictory_labels || failure.code == Code::malformed_labels)
            return refused("refused", failure.message, 400);
        if (desk_.have_tables_changed()) return refused("changed", failure.message, 409);
        return refused("disk", failure.message, 507);
    }

    Desk& desk_;
    Frames& frames_;
    Background& background_;
    const std::string& page_;
    std::string holder_;                              ///< the page that labels
    std::pair<std::string, std::uint64_t> last_key_;  ///< its page and number
    Answer last_answer_;
    Clock::time_point heard_;
};

}  // namespace

Failure serve(Desk& desk, Frames& frames, Background& background, const ServeRequest& request) {
    auto service = Service::start(request.port);
    if (!service) return service.failure();
    if (!request.ready((*service)->address()))
        return {Code::unwritable_output, "the address of the page cannot be printed"};
    Clerk clerk(desk, frames, background, request.page);
    while (const auto asked = (*service)->next())
        if (!(*service)->answer(clerk.answer(asked->path, asked->content))) break;
    return (*service)->ending();
}

std::string page_with(const std::vector<report::PageFile>& own, std::string_view html,
                      const std::string& data) {
    const auto& theirs = report::page_files();
    const report::PageFile& script = report::page_file(own, "page.js");
    const report::PageFile& style = report::page_file(theirs, "page.css");
    const report::PageFile& own_style = report::page_file(page_files(), "label.css");
    const report::PageFile& d3 = report::page_file(theirs, "d3.js");
    return report::filled(
        report::page_file(own, html).text,
        {{"style", std::string(style.text)},
         {"own-style", std::string(own_style.text)},
         {"style-hashes", report::hash_source(style) + " " + report::hash_source(own_style)},
         {"d3", std::string(d3.text)},
         {"d3-licence", std::string(report::page_file(theirs, "d3_licence.txt").text)},
         {"script", std::string(script.text)},
         {"script-hashes", report::hash_source(d3) + " " + report::hash_source(script)},
         {"data", report::in_script(data)}});
}

std::string page_of(const Desk& desk, const PageRequest& request) {
    Json data{{"spec",
               {{"name", request.spec},
                {"path", request.spec_path},
                {"step_seconds", request.step_seconds}}},
              {"predicates", Json::array()},
              {"tables", desk.tables()},
              {"episodes", Json::array()}};
    for (std::size_t p = 0; p < desk.predicates().size(); ++p)
        data["predicates"].push_back(desk.predicate(p));
    for (std::size_t e = 0; e < desk.episodes().size(); ++e) {
        const Episode& episode = desk.episodes()[e];
        data["episodes"].push_back({{"name", episode.name},
                                    {"path", episode.path},
                                    {"steps", episode.steps},
                                    {"table", episode.table},
                                    {"recorded", episode.is_recorded},
                                    {"frames", bool{request.has_frames[e]}}});
    }
    return page_with(page_files(), "label.html",
                     data.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace etlc::label
