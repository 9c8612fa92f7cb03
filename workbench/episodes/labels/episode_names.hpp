// Finds the episodes that a table of labels names.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace etlc::episodes {

/// Returns the folder that an episode lies in; for an episode of a data set, the data set.
std::string folder_of(const std::string& episode);

/// Returns the names of the folders that an episode lies in, from the root to its own: for an
/// episode of an .h5 file its groups too, behind the file; for one of a data set, the data set.
std::vector<std::string> folders_of(const std::string& episode);

/// The indices of the episodes that have a name: of one where the name is its whole path, of two
/// where it is ambiguous.
using Named = std::map<std::string, std::vector<std::size_t>>;

/// Fills in the episodes of each name. A name is the path of an episode, or an end of it that
/// begins with the name of a folder, file, group or data set; the ending of the file may be left
/// out, and zeros before the number of an episode of a data set.
void find_named(const std::vector<std::string>& episodes, Named& names);

/// Returns the shortest name of each episode that no other one has, nor one that lies where these
/// lie; the path where there is none.
std::vector<std::string> shortest_names(const std::vector<std::string>& episodes);

/// Lists the episodes that lie where these lie, and perhaps these too.
std::vector<std::string> neighbours_of(const std::vector<std::string>& episodes);

/// Returns whether a path that is relative to a folder, perhaps without its ending, is an episode.
bool is_episode_in(const std::string& folder, const std::string& name);

}  // namespace etlc::episodes
