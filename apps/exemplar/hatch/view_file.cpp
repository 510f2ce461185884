#include "apps/exemplar/hatch/view_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <xxhash.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/json_text.h"
#include "host/core/text.h"
#include "host/imaging/png.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

constexpr int k_view_format = 1;

nlohmann::json numbers_of(const std::string& text) {
    return parse_json("[" + text + "]");
}

/// Returns numbers as an option takes them. Throws nlohmann::json::exception if `key` holds no list of `count` numbers.
std::string option_text(const nlohmann::json& json, const char* key, std::size_t count) {
    const auto numbers = json.at(key).get<std::vector<float>>();
    if (numbers.size() != count) throw nlohmann::json::other_error::create(501, "wrong number of values", &json);
    return fmt::format("{}", fmt::join(numbers, ","));
}

DrawnView view_from(const nlohmann::json& json) {
    DrawnView view;
    CameraArguments& camera = view.camera;
    if (json.contains("eye")) {
        camera.eye = option_text(json, "eye", 3);
        camera.target = option_text(json, "target", 3);
    } else {
        camera.view = json.at("view").get<std::string>();
    }
    camera.up = option_text(json, "up", 3);
    camera.shift = option_text(json, "shift", 2);
    camera.field_of_view = json.at("fov").get<double>();
    const auto size = json.at("size").get<std::vector<int>>();
    camera.size = fmt::format("{}", fmt::join(size, "x"));
    view.light = option_text(json, "light", 3);
    return view;
}

ViewFile view_file_from(const nlohmann::json& json) {
    const nlohmann::json& mesh = json.at("mesh");
    return {view_from(json),
            {mesh.at("file").get<std::string>(), mesh.at("geometry").get<std::string>(),
             mesh.at("faces").get<std::size_t>()},
            json.value("sheet", std::string()),
            json.value("drawing", std::string())};
}

}  // namespace

DrawnMesh drawn_mesh(const fs::path& path, const TriangleMesh& mesh) {
    const XXH64_hash_t vertices = XXH3_64bits(mesh.vertices.data(), mesh.vertices.size() * sizeof(mesh.vertices[0]));
    const XXH64_hash_t all =
        XXH3_64bits_withSeed(mesh.faces.data(), mesh.faces.size() * sizeof(mesh.faces[0]), vertices);
    return {path.filename().string(), fmt::format("{:016x}", all), mesh.face_count()};
}

std::string view_file_text(const ViewFile& file) {
    const CameraArguments& camera = file.view.camera;
    nlohmann::ordered_json json;
    json["exemplar_view"] = k_view_format;
    json["mesh"] = {{"file", file.mesh.file}, {"faces", file.mesh.faces}, {"geometry", file.mesh.geometry}};
    if (!file.sheet.empty()) json["sheet"] = file.sheet;
    if (!file.drawing.empty()) json["drawing"] = file.drawing;
    if (camera.eye.empty()) {
        json["view"] = camera.view;
    } else {
        json["eye"] = numbers_of(camera.eye);
        json["target"] = numbers_of(camera.target);
    }
    json["up"] = numbers_of(camera.up);
    json["fov"] = camera.field_of_view;
    json["shift"] = numbers_of(camera.shift);
    std::string size = camera.size;
    std::ranges::replace(size, 'x', ',');
    json["size"] = numbers_of(size);
    json["light"] = numbers_of(file.view.light);
    return ordered_json_text(json, -1, true);
}

ViewFile read_view_file(const fs::path& path) {
    const std::string content = read_file(path);
    const bool is_png = content.starts_with("\x89PNG");
    const std::optional<std::string> text = is_png ? png_text(content, k_view_keyword) : content;
    if (!text)
        throw DataError(fmt::format(
            "{}: the picture tells no view; programs that save it anew leave out what 'exemplar hatch template' wrote "
            "into it: give that file",
            path.string()));
    try {
        const nlohmann::json json = parse_json(*text);
        if (json.at("exemplar_view").get<int>() != k_view_format)
            throw DataError(fmt::format("{}: a view of another version of Exemplar; render it again", path.string()));
        return view_file_from(json);
    } catch (const nlohmann::json::exception&) {
        throw DataError(fmt::format(
            "{}: tells no view; give a picture of 'exemplar hatch template' or a file of 'exemplar hatch register'",
            path.string()));
    }
}

void require_mesh_of_view(const fs::path& path, const DrawnMesh& expected, const DrawnMesh& given) {
    if (expected.geometry == given.geometry) return;
    throw DataError(fmt::format("{}: shows another mesh than {} ({}): {} with {}; give that mesh", path.string(),
                                given.file, counted(given.faces, "face"), expected.file,
                                counted(expected.faces, "face")));
}

}  // namespace exemplar
