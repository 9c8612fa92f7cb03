// Names of documents: what the client calls them, and which files they are.
#pragma once

#include <string>
#include <string_view>

namespace etlc::lsp {

/// The path of a file: URI; of another, such as an unsaved text, its last part, so that what the
/// spec loads is looked for where etlc runs.
std::string path_of_uri(std::string_view uri);

/// The file: URI of a path, which is made absolute.
std::string uri_of_path(const std::string& path);

}  // namespace etlc::lsp
