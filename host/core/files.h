#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <memory>
#include <string>
#include <string_view>

namespace exemplar {

/// Writes a whole file so that readers never see half of it: `write` fills a stream to a temporary file beside `path`,
/// which is renamed over `path` when the stream closed without an error and removed otherwise.
/// A link is followed; a terminal or pipe is written to directly. Creates missing parent folders. Throws DataError
/// naming the path and the system's reason.
void write_file_atomically(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

/// The whole content of a file; throws DataError naming the path if it cannot be read.
std::string read_file(const std::filesystem::path& path);

/// The whole content of a file, for as long as the owner lives.
struct FileView {
    std::string_view content;
    std::shared_ptr<const void> owner;
};

/// As read_file, for readers that keep parts of the file.
FileView hold_file(const std::filesystem::path& path);

/// As hold_file, without a copy where the system can map the file into memory. For files that are replaced and never
/// rewritten, as write_file_atomically does: a program that loses pages it has mapped is ended by the system.
FileView view_file(const std::filesystem::path& path);

/// " (did you mean 'FOLDER/NAME'?)" with the name in the folder of `path` that is most like its own; empty if none is.
std::string suggest_file(const std::filesystem::path& path);

}  // namespace exemplar
