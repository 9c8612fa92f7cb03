// Calls whose episodes are shared out among processes: `--shard I/N` and `etlc merge`.
// Takes: which shard of a call this is, or the parts that all shards wrote. Gives: a part, or what
// the call without shards would have given. Keeps true: parts are merged with the spec, and the
// files that it loads, as the shards had them; a part appears whole or not at all.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "diag/diag.hpp"
#include "episodes/shared/sharing.hpp"

namespace etlc::driver {

struct ShardRequest {
    std::uint32_t shard = 0;   ///< 1 to `shards`
    std::uint32_t shards = 0;  ///< 0: the call is not shared out
    std::string part;          ///< the file that this shard writes
    /// Which shards, standard input says, a number a line. Each goes to NUMBER.part in the folder
    /// `part`, and its number to standard output. `shard` is 0.
    bool from_input = false;
};

/// `call`: the arguments, from the command on. Nothing where it is not shared out.
std::optional<episodes::Sharing> sharing_of(const ShardRequest& request,
                                            std::vector<std::string> call);

/// The episodes of the call: as data::find_episodes, or those of the parts.
std::vector<std::string> find_shared_episodes(episodes::Sharing* sharing,
                                              const std::vector<std::string>& data,
                                              const std::string& groups, diag::Sink& sink);

/// Notes the content of the spec and of what it loads; where parts are merged, compares it. False
/// where the sink now says that it is another.
bool note_loaded(episodes::Sharing* sharing, std::vector<std::string> loaded, diag::Sink& sink);

/// The parts that are merged; none, where none are.
std::vector<std::string> merged_files(const episodes::Sharing* sharing);

/// Whether this is one shard, which ends with its part.
bool is_shard(const episodes::Sharing* sharing);
bool write_part(episodes::Sharing& sharing, const std::string& path, diag::Sink& sink);

/// Where this process is one of several ranks of an MPI job, and the command is one that ranks
/// share, goes on as etlc-mpi and does not return, unless it cannot be run: then false.
bool go_on_in_ranks(char** argv);

/// All parts of a call. Nothing where the sink now says why.
std::optional<episodes::Sharing> read_parts(const std::vector<std::string>& paths,
                                            diag::Sink& sink);

/// The call without shards, whose result goes to `output`; empty: where the call says.
std::vector<std::string> merged_call(const episodes::Part& part, const std::string& output);

}  // namespace etlc::driver
