#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>

namespace exemplar {

/// Writes a whole file so that readers never see half of it: `write` fills a stream to a temporary file beside `path`,
/// which is renamed over `path` when the stream closed without an error and removed otherwise.
/// A link is followed; a terminal or pipe is written to directly. Creates missing parent folders. Throws DataError
/// naming the path and the system's reason.
void write_file_atomically(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

/// The whole content of a file; throws DataError naming the path if it cannot be read.
std::string read_file(const std::filesystem::path& path);

/// " (did you mean 'FOLDER/NAME'?)" with the name in the folder of `path` that is most like its own; empty if none is.
std::string suggest_file(const std::filesystem::path& path);

}  // namespace exemplar
