// `etlc prove`: proves a generated class, or shows an input on which it is wrong. `etlc dossier`
// keeps the certificate.
#include "prove/prove.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "data/files/file.hpp"
#include "data/files/hash.hpp"
#include "driver/commands/commands.hpp"
#include "driver/process/process.hpp"
#include "emit/emit.hpp"
#include "emit/standalone.hpp"
#include "library/version.hpp"
#include "source/text.hpp"

namespace etlc::driver {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostHeaderBytes = 64U << 20U;

std::string hash_of(std::string_view text) {
    return data::hash_text(data::xxh64(text));
}

/// Returns the hash of files that an etlc contains.
std::string hash_of(const std::vector<emit::RuntimeFile>& files) {
    std::uint64_t hash = 0;
    for (const emit::RuntimeFile& file : files)
        hash = data::xxh64(file.text, data::xxh64(file.name, hash));
    return data::hash_text(hash);
}

/// Returns a line for a message.
std::string shown_line(std::string_view line) {
    constexpr std::size_t kMost = 100;
    if (line.ends_with('\n')) line.remove_suffix(1);
    return "'" + source::visible(line.substr(0, kMost)) + (line.size() > kMost ? "...'" : "'");
}

/// Returns where a header first differs from the one that etlc generates.
std::string first_difference(std::string_view found, std::string_view expected) {
    const std::vector<std::string_view> is = split_lines(found), should_be = split_lines(expected);
    const std::size_t at = static_cast<std::size_t>(
        std::mismatch(is.begin(), is.end(), should_be.begin(), should_be.end()).first - is.begin());
    const std::string there = at < is.size() ? shown_line(is[at]) : "the end of the file";
    const std::string line =
        at < should_be.size() ? shown_line(should_be[at]) : "the end of the file";
    if (there == line) return fmt::format("line {} ends in another way", at + 1);
    return fmt::format("line {} is {}; expected {}", at + 1, there, line);
}

/// Returns the header that etlc generates. That of --header has to be the same, byte for byte.
std::optional<std::string> header_text(const source::File& spec, const plan::Plan& plan,
                                       const Request& request, diag::Sink& sink) {
    const std::string& file = request.prove.header;
    const fs::path named = file.empty() ? spec.path() : file;
    std::string generated = emit::header(
        plan, {request.name_space, library::kVersion, "", named.stem().string() + ".targets.bin"});
    if (file.empty()) return generated;
    const auto text =
        data::read_file(file, kMostHeaderBytes, diag::Code::no_proof, data::Streams::refused);
    if (!text) {
        sink.report(data::in_file(text.failure(), file));
        return std::nullopt;
    }
    if (*text == generated) return generated;
    sink.report(data::in_file(
                    {diag::Code::no_proof,
                     "not the header that this etlc generates from the spec with these options: " +
                         first_difference(*text, generated)},
                    file))
        .note("generate it again, without --standalone and with the options of this call");
    return std::nullopt;
}

/// Returns the options that change the class, as they are in the call.
std::string options_of(const plan::Plan& plan, const Request& request) {
    std::vector<std::string> words;
    if (plan.values == check::Values::sourced) words.emplace_back("--explain");
    if (plan.values == check::Values::boolean) words.emplace_back("--values boolean");
    if (plan.recorder)
        words.push_back(fmt::format("--recorder {},{},{}", plan.recorder->before,
                                    plan.recorder->after, plan.recorder->incidents));
    if (request.check.retargetable) words.emplace_back("--retargetable");
    if (request.check.lets) words.emplace_back("--lets");
    return words.empty() ? "none" : fmt::format("{}", fmt::join(words, " "));
}

std::size_t restarting(const plan::Plan& plan) {
    return static_cast<std::size_t>(std::count_if(
        plan.monitors.begin(), plan.monitors.end(),
        [](const plan::Monitor& monitor) { return monitor.restarts != check::Restarts::never; }));
}

std::string restarts_of(const plan::Plan& plan, const prove::Proof& proof) {
    const std::size_t count = restarting(plan);
    if (count == 0) return "";
    if (count == 1) return "proved for all sequences of restarts\n";
    std::string text = "proved for all sequences of restarts of one monitor";
    if (proof.together > 0)
        text +=
            fmt::format(", and of several in the first {}", diag::counted(proof.together, "step"));
    if (proof.together >= proof.steps) return text + "\n";
    return text + "\nnot proved: that restarts of several monitors do not disturb each other" +
           (proof.together > 0 ? " later\n" : "\n");
}

/// Returns what a certificate says of itself.
std::string scope_of(const plan::Plan& plan, const prove::Proof& proof) {
    const bool boolean = plan.values == check::Values::boolean;
    const bool measures = !plan.model->retargetable;
    return fmt::format(
        "\nscope: the header above, which is what this etlc generates from this spec, and no "
        "other.\n"
        "driven: constructed in memory that holds anything; {}{}reset() after each of these "
        "calls; restarts\n"
        "proved: every verdict, by its name, with its status, for all values of predicates and "
        "bools, any of which may be missing\n"
        "state: {}, as planned; the object of the class has no other data that can be written\n"
        "not proved: distances, expressions, thresholds, hold, stale after and points of earlier "
        "steps; calibrated shifts;\n"
        "  telemetry but the counts of alarms; lets, explanations and the recorder; other orders "
        "of "
        "calls\n"
        "assumed: the compiler of the product compiles C++ correctly, and the stand-ins do what "
        "the files of the runtime do that they replace\n",
        measures  ? "step(), with samples and without; "
        : boolean ? "step(), without samples; "
                  : "judge(), not step(); ",
        proof.finishes > 0 ? fmt::format("up to {} of finish() after each step; ",
                                         diag::counted(proof.finishes, "call"))
                           : "",
        diag::counted(plan.cost.state_bytes, "byte"));
}

std::string certificate(const source::File& spec, const plan::Plan& plan, const Request& request,
                        const std::string& header, const prove::Proof& proof) {
    std::vector<std::string> monitors;
    for (const plan::Monitor& monitor : plan.monitors) monitors.push_back(monitor.name);
    std::string text = fmt::format(
        "etlc prove: the verdicts of a generated class\n\n"
        "spec      {}, XXH64 {}\n"
        "header    XXH64 {}\n"
        "options   {}\n"
        "etlc      {}, runtime XXH64 {}, stand-ins XXH64 {}\n"
        "compiler  {}\n"
        "monitors  {}\n"
        "steps     {}\n\n"
        "proved for all inputs of up to {}: {} were compared\n",
        fs::path(spec.path()).filename().string(), hash_of(spec.text()), hash_of(header),
        options_of(plan, request), library::kVersion, hash_of(emit::runtime_files()),
        hash_of(prove::stand_in_files()), proof.compiler, fmt::join(monitors, ", "), proof.steps,
        diag::counted(proof.steps, "step"), diag::counted(proof.verdicts, "verdict"));
    if (proof.repeats)
        text += fmt::format(
            "proved for all lengths{}: step {} leaves the class and the definition in the form of "
            "step {}\n",
            restarting(plan) > 0 ? " without restarts" : "", proof.repeats->second,
            proof.repeats->first);
    else
        text += fmt::format("not proved for longer inputs: {}\n", proof.why_not_longer);
    const auto lengths = [](const std::vector<std::uint32_t>& windows) {
        const std::set<std::uint32_t> each(windows.begin(), windows.end());
        return fmt::format("{}", fmt::join(each, ", "));
    };
    if (!proof.windows.empty())
        text += fmt::format(
            "proved of its windows, of {} steps: missing samples may come in any "
            "order, at any length\n",
            lengths(proof.windows));
    if (!proof.long_windows.empty())
        text += fmt::format(
            "assumed of its windows of {} steps, which are too long for this "
            "proof: the same\n",
            lengths(proof.long_windows));
    return text + restarts_of(plan, proof) + scope_of(plan, proof);
}

/// Returns the measurements of a witness, as a trace.
std::string trace_of(const plan::Plan& plan, const prove::Proof& proof) {
    const check::Model& model = *plan.model;
    std::vector<std::string> names;
    std::vector<std::size_t> columns;
    for (const check::Index p : plan.predicates) {
        names.push_back(measured_name(model, p, names.size() + 1));
        for (std::size_t a = 0; a < proof.atoms.size(); ++a)
            if (proof.atoms[a].is_predicate && proof.atoms[a].index == p) columns.push_back(a);
    }
    for (std::size_t a = 0; a < proof.atoms.size(); ++a)
        if (!proof.atoms[a].is_predicate && proof.atoms[a].is_read) {
            names.push_back(model.inputs[proof.atoms[a].index].name);
            columns.push_back(a);
        }
    std::string text = csv_line(std::move(names));
    for (const auto& values : proof.fault->witness.values) {
        std::vector<std::string> cells;
        for (const std::size_t a : columns) {
            const prove::Atom& atom = proof.atoms[a];
            if (!values[a]) {
                cells.emplace_back();
            } else if (!atom.is_predicate) {
                cells.emplace_back(*values[a] > 0 ? "1" : "0");
            } else {
                cells.push_back(fmt::format(
                    "{:.9g}", prove::measured(model.predicates[atom.index], *values[a])));
            }
        }
        text += csv_line(std::move(cells));
    }
    return text;
}

std::string said(const plan::Plan& plan, const prove::Fault& fault) {
    std::string where = fmt::format("after step {}", fault.step);
    if (fault.finishes > 0)
        where += fmt::format(" and {} of finish()", diag::counted(fault.finishes, "call"));
    for (const auto& [monitor, step] : fault.restarts)
        where += fmt::format(", '{}' restarted before step {}", plan.monitors[monitor].name, step);
    const std::string& name = plan.monitors[fault.monitor].name;
    if (plan.values == check::Values::boolean)
        return fmt::format("'{}' {}: {} {} in the class, but {}by the definition", name, where,
                           fault.witness.first_reaches ? "is" : "is not", fault.number,
                           fault.witness.first_reaches ? "not " : "");
    if (fault.witness.values.empty())
        return fmt::format("'{}' {}: the class and the definition differ in {}", name, where,
                           fault.number);
    return fmt::format("'{}' {}: {} is {} {:.9g} in the class, and {} by the definition", name,
                       where, fault.number, fault.witness.first_reaches ? "at least" : "less than",
                       fault.witness.threshold,
                       fault.witness.first_reaches ? "less" : "at least that");
}

void write_counterexample(const source::File& spec, const plan::Plan& plan, const Request& request,
                          const prove::Proof& proof, diag::Sink& sink) {
    const std::string stem = request.prove.counterexample.empty()
                                 ? fs::path(spec.path()).stem().string() + ".counterexample"
                                 : request.prove.counterexample;
    auto& found = sink.report(diag::Code::wrong_class,
                              plan.model->monitors[plan.monitors[proof.fault->monitor].index].span,
                              said(plan, *proof.fault));
    if (proof.fault->witness.values.empty()) return;
    found.note(fmt::format("the definition's verdicts: etlc run {0}.etl --trace {0}.csv{1}{2}",
                           stem, plan.values == check::Values::boolean ? " --values boolean" : "",
                           proof.fault->finishes > 0 ? " --finish" : ""));
    OutputFiles files(sink);
    if (check_outputs({stem + ".csv", stem + ".etl"}, files_read(*plan.model, spec, {}), sink) &&
        files.add(stem + ".csv", trace_of(plan, proof)) &&
        files.add(stem + ".etl", measured_spec(plan)))
        files.commit();
}

}  // namespace

std::optional<Certified> certify(const source::File& spec, const plan::Plan& plan,
                                 const Request& request, bool counts_lines, diag::Sink& sink) {
    for (const check::Index drift : plan.drifts)
        sink.report(diag::Code::no_proof, plan.model->drifts[drift].span,
                    "a class with a drift branches on distances, which have no value in a proof")
            .note("prove the class without it: no verdict depends on a drift");
    if (sink.has_errors()) return std::nullopt;
    auto header = header_text(spec, plan, request, sink);
    if (!header) return std::nullopt;
    const std::string name_space =
        request.name_space.empty() ? plan.model->name : request.name_space;
    prove::Request asked{*header, name_space, request.prove.steps};
    asked.counts_lines = counts_lines;
    const auto proof = prove::prove(plan, asked);
    if (!proof) {
        sink.report(data::in_file(proof.failure(), spec.path()));
        return std::nullopt;
    }
    if (proof->fault) {
        write_counterexample(spec, plan, request, *proof, sink);
        return std::nullopt;
    }
    std::string text = certificate(spec, plan, request, *header, *proof);
    return Certified{std::move(*header), std::move(text), proof->coverage};
}

bool prove(const source::File& spec, const Compiled& compiled, const Request& request,
           diag::Sink& sink) {
    std::vector<std::string> inputs = files_read(*compiled.plan.model, spec, {});
    if (!request.prove.header.empty()) inputs.push_back(request.prove.header);
    if (!check_outputs({request.output}, inputs, sink)) return false;
    const auto certified = certify(spec, compiled.plan, request, false, sink);
    OutputFiles files(sink);
    return certified && files.add(request.output, certified->text) && files.commit();
}

}  // namespace etlc::driver
