#include "python/views.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <system_error>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/text.h"
#include "host/lines/drawing.h"
#include "python/arrays.h"

namespace exemplar::python {
namespace {

namespace fs = std::filesystem;

/// A file that ends with this.
class TemporaryFile {
  public:
    TemporaryFile() : path_((fs::temp_directory_path() / "exemplar-XXXXXX").string()) {
        const int file = mkstemp(path_.data());
        if (file < 0) throw DataError(fmt::format("{}: a temporary file cannot be made", path_));
        close(file);
    }
    ~TemporaryFile() {
        std::error_code ignored;
        fs::remove(path_, ignored);
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    fs::path path() const { return path_; }

  private:
    std::string path_;
};

}  // namespace

ViewPoint view_point_of(const ViewArguments& arguments) {
    ViewPoint point;
    point.view = arguments.view;
    const std::vector<std::string> names = view_names();
    if (!view_direction(point.view))
        throw UsageError(fmt::format("view: '{}' is no view{}; the views are {}, or give an eye", point.view,
                                     suggestion(point.view, names), fmt::join(names, ", ")));
    if (!arguments.eye.is_none()) point.eye = vector_of(arguments.eye, "eye");
    if (!arguments.target.is_none()) point.target = vector_of(arguments.target, "target");
    if (point.target && !point.eye) throw UsageError("target: is where an eye looks; give eye, too");
    point.up = vector_of(arguments.up, "up");
    if (!(point.up.norm() > 0)) throw UsageError("up: is zero; give a direction as (0, 1, 0)");
    require_range("field_of_view", arguments.field_of_view, 0, 170);
    point.field_of_view = arguments.field_of_view;
    require_range("size", arguments.size.first, std::int64_t{1}, std::int64_t{k_max_picture_size});
    require_range("size", arguments.size.second, std::int64_t{1}, std::int64_t{k_max_picture_size});
    point.width = static_cast<int>(arguments.size.first);
    point.height = static_cast<int>(arguments.size.second);
    return point;
}

std::vector<std::string> line_type_names() {
    std::vector<std::string> names;
    names.reserve(k_line_types.size());
    for (const LineType type : k_line_types) names.emplace_back(name_of(type));
    return names;
}

std::vector<LineType> line_types_of(const std::vector<std::string>& words) {
    std::vector<std::string> names = line_type_names();
    names.emplace_back("all");
    std::vector<LineType> wanted, types;
    for (const std::string& word : words) {
        const std::optional<LineType> type = line_type_from_prefix(word);
        if (!type && word != "all")
            throw UsageError(fmt::format("'{}' is no type of lines{}; the types are {}", word, suggestion(word, names),
                                         fmt::join(names, ", ")));
        if (type)
            wanted.push_back(*type);
        else
            wanted.insert(wanted.end(), k_line_types.begin(), k_line_types.end());
    }
    for (const LineType type : drawing_order())
        if (std::ranges::find(wanted, type) != wanted.end()) types.push_back(type);
    return types;
}

std::string written_text(const std::function<void(const fs::path&)>& write) {
    const TemporaryFile file;
    write(file.path());
    return read_file(file.path());
}

}  // namespace exemplar::python
