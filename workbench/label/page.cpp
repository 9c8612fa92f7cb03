#include "label/page.hpp"

#include <cstddef>
#include <nlohmann/json.hpp>

#include "report/document.hpp"

namespace etlc::label {

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
    using Json = nlohmann::ordered_json;
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
