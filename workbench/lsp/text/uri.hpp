// Converts between the URIs of documents and the paths of files.
#pragma once

#include <string>
#include <string_view>

namespace etlc::lsp {

/// Returns the path of a file: URI. For any other, such as that of an unsaved text, returns the
/// last part, so that files of the spec are looked for in the working directory.
std::string path_of_uri(std::string_view uri);

/// Returns the file: URI of a path, which is made absolute.
std::string uri_of_path(const std::string& path);

}  // namespace etlc::lsp
