// The commands of etlc, each a function from a spec and a request to files and findings.
// Takes: the text of the spec, or its plan. Keeps true: output files appear whole, when all of a
// command are complete; a function that returns false or nothing has reported why.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "artifacts/fitted.hpp"
#include "artifacts/thresholds.hpp"
#include "check/model/model.hpp"
#include "compile.hpp"
#include "diag/diag.hpp"
#include "driver/commands/request.hpp"
#include "driver/process/process.hpp"
#include "episodes/shared/sharing.hpp"
#include "evaluate/evaluate.hpp"
#include "plan/plan.hpp"
#include "source/source.hpp"

namespace etlc::driver {

// ---- compiling ----------------------------------------------------------------------------------

/// `etlc SPEC.etl`: writes the header or another stage, the files of large target sets and of
/// parameters, and the rule of their dependencies.
bool emit(const source::File& file, const Request& request, diag::Sink& sink);

/// Returns the values of --emit, each with a summary for --help.
std::vector<std::pair<std::string, std::string>> emittable();

// ---- commands that need the plan ----------------------------------------------------------------

/// `etlc run`: executes the plan on a recorded trace, in constant memory and linear time. Writes a
/// CSV row for each step and monitor, or a summary.
bool run(const source::File& spec, const Compiled& compiled, const Request& request,
         diag::Sink& sink);
/// `etlc explain`: explains a verdict on a recorded trace.
bool explain(const source::File& spec, const Compiled& compiled, const Request& request,
             diag::Sink& sink);
/// `etlc incident`: prints what the flight recorder of a monitor wrote. Refuses a file that is
/// damaged, or that was written by a monitor of another spec, other data or other thresholds.
bool incident(const source::File& spec, const Compiled& compiled, const Request& request,
              diag::Sink& sink);
/// `etlc watch`: steps the monitors with a camera or a trace as it comes, until it ends or somebody
/// asks for the end.
bool watch(const source::File& spec, const Compiled& compiled, const Request& request,
           diag::Sink& sink);
/// `etlc report`: writes a page about recorded episodes, with the figures of `etlc evaluate`.
bool report(const source::File& spec, const Compiled& compiled, const Request& request,
            diag::Sink& sink);

/// Makes the page of one trace, without truths.
std::optional<std::string> page_of_trace(const source::File& spec, const Compiled& compiled,
                                         const std::string& trace,
                                         const recordings::NamesInFile& names, diag::Sink& sink);

/// `etlc annotate`: writes what the monitors say of a data set into a copy of it, or a list of its
/// episodes.
bool annotate(const source::File& spec, const Compiled& compiled, const Request& request,
              diag::Sink& sink);

// ---- commands that fill in what a spec lacks ----------------------------------------------------

/// `etlc prove`: compares the class with the definition of its verdicts, for all inputs of a number
/// of steps. Writes a certificate, or an input on which the class is wrong.
bool prove(const source::File& spec, const Compiled& compiled, const Request& request,
           diag::Sink& sink);

struct Certified {
    std::string header;    ///< that was proved
    std::string text;      ///< the certificate
    std::string coverage;  ///< prove::Proof::coverage
};
/// Proves the class. Nothing after an error: there is no proof, or the class is wrong, for which it
/// writes the input.
std::optional<Certified> certify(const source::File& spec, const plan::Plan& plan,
                                 const Request& request, bool counts_lines, diag::Sink& sink);

/// `etlc dossier`: collects in a folder what an engineer needs who signs for the class.
bool dossier(const source::File& spec, const Compiled& compiled, const Request& request,
             diag::Sink& sink);

/// `etlc embed`: writes the file of embeddings, and an episode for each recording (of its shard).
bool embed(const source::File& file, const Request& request, diag::Sink& sink);
/// `etlc fit`: writes the file of fitted entries. The report goes to standard output, or to
/// standard error where the file goes to standard output; so does that of `etlc calibrate`.
bool fit(const source::File& file, const Request& request, diag::Sink& sink);
/// `etlc calibrate`: writes the file of thresholds.
bool calibrate(const source::File& file, const Request& request, diag::Sink& sink);
/// `etlc label`: serves the page on which episodes are labelled until the process is stopped, or
/// prints proposals for their labels.
bool label(const source::File& file, const Request& request, diag::Sink& sink);

// ---- evaluation ---------------------------------------------------------------------------------

/// A spec and what is found in it.
struct SpecToJudge {
    const source::File& file;
    diag::Sink& sink;
};

/// `etlc evaluate` and `etlc crossvalidate`: compares the monitors of specs with ground truth.
/// Every episode is judged by monitors that have not seen it.
bool evaluate(const std::vector<SpecToJudge>& specs, const Request& request);

/// Judges a compiled spec by the thresholds that it has.
std::optional<evaluate::Judgement> judge_as_it_is(const Compiled& compiled, const std::string& spec,
                                                  const Request& request,
                                                  const evaluate::Request& asked, diag::Sink& sink);

// ---- shared -------------------------------------------------------------------------------------

/// Allows that thresholds and fitted entries do not exist yet.
check::Options without_results(check::Options options);

/// Reads the file of the spec's thresholds; nothing where no threshold is calibrated.
std::optional<thresholds::File> thresholds_of(const check::Model& model, const std::string& spec,
                                              const Request& request);
/// Reads the file of the spec's fitted entries; empty where the spec has none.
fitted::File fitted_file(const check::Model& model, const std::string& spec,
                         const Request& request);

/// Reports the names of --map that no spec has, E0804; false where there are any.
bool check_names(const std::vector<const check::Model*>& models,
                 const recordings::NamesInFile& names, diag::Sink& sink);

/// Reads the labels that lie beside the episodes or that the call names into `reading`. Returns
/// false after an error.
bool read_labels(const std::vector<const check::Model*>& models, const Request& request,
                 const std::vector<std::string>& episodes, episodes::ReadOptions& reading,
                 diag::Sink& sink);

/// Returns the files that a call reads: the spec, its dependencies, recordings and their labels.
std::vector<std::string> files_read(const check::Model& model, const source::File& spec,
                                    const std::vector<std::string>& recordings,
                                    const episodes::ReadOptions& reading = {});

/// Copies what the requests of fit, calibrate, evaluate and report have in common.
template <class Asked>
Asked asked_of(const Request& request) {
    Asked asked;
    asked.reading.names = request.names;
    asked.jobs = request.jobs;
    asked.progress = episodes_progress();
    return asked;
}

// ---- --shard I/N and etlc merge -----------------------------------------------------------------

/// Returns the sharing of a call that reads one shard, or the shards that standard input lists;
/// nothing where the call reads all episodes.
std::optional<episodes::Sharing> sharing_of(const Request& request);

/// Finds the episodes of the call, or takes them from the parts that are merged.
std::vector<std::string> find_shared_episodes(episodes::Sharing* sharing,
                                              const std::vector<std::string>& data,
                                              const recordings::Chosen& chosen, diag::Sink& sink);

/// Records hashes of the spec and its dependencies in the part; where parts are merged, compares
/// them and reports a difference.
bool note_loaded(episodes::Sharing* sharing, std::vector<std::string> loaded, diag::Sink& sink);

/// Returns the files of the parts that are merged.
std::vector<std::string> merged_files(const episodes::Sharing* sharing);

/// Returns whether the call reads a shard and writes a part in place of a result.
bool is_shard(const episodes::Sharing* sharing);
bool write_part(episodes::Sharing& sharing, const std::string& path, diag::Sink& sink);

/// Continues as etlc-mpi where this process is one of several ranks of an MPI job and the command
/// is one that ranks share. Returns false where etlc-mpi cannot be run.
bool go_on_in_ranks(char** argv);

/// Reads all parts of a call.
std::optional<episodes::Sharing> read_parts(const std::vector<std::string>& paths,
                                            diag::Sink& sink);

/// Returns the call without shards, with its result in `output` unless that is empty.
std::vector<std::string> merged_call(const episodes::Part& part, const std::string& output);

/// Returns the lines of a text, each with its end.
std::vector<std::string_view> split_lines(std::string_view text);

// Traces of measurements in place of inputs: `distance_P` for each predicate P, and the bools.

/// Returns a row of a CSV file.
std::string csv_line(std::vector<std::string> cells);

/// Names the column of a predicate, which is the `number`-th of the plan, from 1.
std::string measured_name(const check::Model& model, check::Index p, std::size_t number);

/// Returns the spec that reads such a trace: `predicate p = distance_p <= 0.4`.
std::string measured_spec(const plan::Plan& plan);

}  // namespace etlc::driver
