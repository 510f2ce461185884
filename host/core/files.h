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

/// Returns the whole content of a file; throws DataError naming the path if it cannot be read.
std::string read_file(const std::filesystem::path& path);

/// The whole content of a file; valid while `owner` lives.
struct FileView {
    std::string_view content;
    std::shared_ptr<const void> owner;
};

/// Reads a file like read_file, for readers that keep references to parts of it.
FileView hold_file(const std::filesystem::path& path);

/// Reads a file like hold_file, but maps it into memory without a copy where the system can. Only for files that are
/// replaced and never rewritten in place, as write_file_atomically does: the system kills a program whose mapped
/// pages vanish.
FileView view_file(const std::filesystem::path& path);

/// Returns " (did you mean 'FOLDER/NAME'?)" with the name in the folder of `path` that is most similar to its own;
/// an empty string if none is similar enough.
std::string suggest_file(const std::filesystem::path& path);

}  // namespace exemplar
