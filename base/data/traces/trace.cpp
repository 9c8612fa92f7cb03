#include "data/traces/trace.hpp"

namespace etlc::data {

std::vector<Channel> renamed(std::vector<Channel> channels, const NamesInFile& names) {
    for (Channel& channel : channels) channel.name = name_in_file(channel.name, names);
    return channels;
}

const std::string& name_in_file(const std::string& name, const NamesInFile& names) {
    const auto found = names.find(name);
    return found == names.end() ? name : found->second;
}

}  // namespace etlc::data
