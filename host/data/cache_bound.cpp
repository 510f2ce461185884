#include "host/data/cache_bound.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <ctime>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <tuple>
#include <vector>

#include "host/core/errors.h"
#include "host/mesh/io/io_text.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

constexpr float k_default_gigabytes = 20, k_max_gigabytes = 1e9F;
constexpr std::time_t k_day = 24 * 60 * 60;  ///< longer than writing any entry takes

struct Entry {
    fs::path path;
    timespec used;
    std::uint64_t bytes;
    bool operator<(const Entry& other) const {
        return std::tie(used.tv_sec, used.tv_nsec, path) < std::tie(other.used.tv_sec, other.used.tv_nsec, other.path);
    }
};

struct Listing {
    std::vector<Entry> entries;
    std::vector<fs::path> left_behind;  ///< temporary files of writers that ended before they were done
    std::uint64_t bytes = 0;            ///< of the entries
};

/// Returns whether a name begins with a content hash (32 hexadecimal digits and '-'), unlike any name a person would
/// give.
bool begins_with_hash(std::string_view name) {
    constexpr std::size_t k_digits = 32;
    return name.size() > k_digits && name[k_digits] == '-' &&
           name.substr(0, k_digits).find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

void take_up(const fs::path& path, std::time_t now, Listing& listing) {
    const std::string name = path.filename().string();
    const bool whole = name.ends_with(".safetensors");
    const bool unfinished = name.find(".safetensors.") != std::string::npos && name.ends_with(".tmp");
    struct stat status = {};
    if (!begins_with_hash(name) || !(whole || unfinished)) return;
    if (lstat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return;
    if (whole) {
        listing.entries.push_back({path, status.st_mtim, static_cast<std::uint64_t>(status.st_size)});
        listing.bytes += listing.entries.back().bytes;
    } else if (now - status.st_mtim.tv_sec > k_day) {
        listing.left_behind.push_back(path);
    }
}

Listing list_cache(const fs::path& folder) {
    Listing listing;
    const std::time_t now = std::time(nullptr);
    std::error_code error;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
        take_up(it->path(), now, listing);
    return listing;
}

/// Removes a file; returns whether it is gone, by this or another process.
bool remove_file(const fs::path& path) {
    return unlink(path.c_str()) == 0 || errno == ENOENT;
}

}  // namespace

std::uint64_t cache_bound() {
    const char* value = std::getenv("EXEMPLAR_CACHE_GB");
    if (!value || !*value) return static_cast<std::uint64_t>(1e9 * k_default_gigabytes);
    const std::optional<float> gigabytes = mesh_io::parse_float(value);
    if (!gigabytes || !(*gigabytes >= 0 && *gigabytes <= k_max_gigabytes))
        throw UsageError(
            fmt::format("EXEMPLAR_CACHE_GB is {}; give the gigabytes that remembered results may take, "
                        "such as 20, or 0 to remember nothing",
                        mesh_io::quote(value)));
    return static_cast<std::uint64_t>(1e9 * static_cast<double>(*gigabytes));
}

void trim_cache(const fs::path& folder, std::uint64_t max_bytes, const fs::path& newest) {
    Listing listing = list_cache(folder);
    for (const fs::path& path : listing.left_behind) remove_file(path);
    if (listing.bytes <= max_bytes) return;
    std::ranges::sort(listing.entries, std::less<>());
    for (const Entry& entry : listing.entries) {
        if (listing.bytes <= max_bytes / 10 * 9) return;
        if (entry.path.filename() != newest.filename() && remove_file(entry.path)) listing.bytes -= entry.bytes;
    }
}

}  // namespace exemplar
