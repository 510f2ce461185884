#include "apps/viewer/scene/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "host/animation/read_animation.h"
#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/text.h"
#include "host/data/corpus.h"
#include "host/mesh/editing/validate.h"
#include "host/mesh/io/io.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

std::string lower_extension(const fs::path& path) {
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
    return extension;
}

void color_by(Document& document, const FaceLabels& labels) {
    document.legend.clear();
    for (std::size_t i = 0; i < labels.names.size(); ++i) document.legend.push_back({labels.names[i], label_color(i)});
    document.face_colors.clear();
    for (const std::uint32_t source : document.source_face) {
        const std::int32_t label = labels.label.at(source);
        document.face_colors.push_back(label < 0 ? k_unlabeled_color : label_color(static_cast<std::size_t>(label)));
    }
}

FaceLabels segments_as_labels(const std::vector<std::int32_t>& segments) {
    FaceLabels labels;
    labels.label = segments;
    const std::int32_t most = segments.empty() ? -1 : *std::ranges::max_element(segments);
    for (std::int32_t i = 0; i <= most; ++i) labels.names.push_back(fmt::format("segment {}", i));
    return labels;
}

// Adds labels found beside the mesh. Errors in them become remarks, as the mesh can be shown without labels.
void add_labels_beside(Document& document) {
    const fs::path segments = fs::path(document.path).replace_extension(".seg");
    for (const fs::path& candidate : {labels_path(document.path), segments}) {
        if (!fs::exists(candidate)) continue;
        try {
            add_labels(document, candidate);
        } catch (const Error& error) {
            document.remarks.emplace_back(error.what());
            continue;
        }
        return;
    }
}

// Drops faces that name a vertex twice: they have no area, and cannot be part of rings of faces.
void drop_degenerate_faces(Document& document, const std::string& name) {
    std::vector<Face>& faces = document.animation.rest.faces;
    std::size_t kept = 0;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const Face face = faces[f];
        if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) continue;
        faces[kept] = face;
        document.source_face[kept++] = document.source_face[f];
    }
    if (kept == 0) throw MeshError(fmt::format("{}: no face has three different vertices; nothing can be shown", name));
    if (kept < faces.size())
        document.remarks.push_back(
            fmt::format("{}: {} left out, which name a vertex twice", name, counted(faces.size() - kept, "face")));
    faces.resize(kept);
    document.source_face.resize(kept);
}

// Flips all faces, as lines are drawn where the surface faces the eye.
void turn_outward(Document& document) {
    for (Face& face : document.animation.rest.faces) std::swap(face[1], face[2]);
    document.remarks.emplace_back("the surface is inside out; its faces were turned around");
}

Document document_of_mesh(const fs::path& path) {
    MeshFile file = read_mesh(path);
    const MeshReport report = require_usable(file.mesh, path.string());
    Document document;
    document.path = path;
    document.remarks = std::move(file.warnings);
    document.animation.name = path.filename().string();
    document.source_face.resize(file.mesh.face_count());
    for (std::uint32_t f = 0; f < document.source_face.size(); ++f) document.source_face[f] = file.mesh.source_of(f);
    document.source_face_count = file.mesh.source_face_count;
    document.animation.rest.vertices = std::move(file.mesh.vertices);
    document.animation.rest.faces = std::move(file.mesh.faces);
    if (report.inside_out) turn_outward(document);
    drop_degenerate_faces(document, path.string());
    document.animation.rest.source_face_count = static_cast<std::uint32_t>(document.source_face.size());
    if (file.labels)
        color_by(document, *file.labels);
    else
        add_labels_beside(document);
    return document;
}

Document document_of_animation(const fs::path& path) {
    Document document;
    document.path = path;
    document.animation = read_animation(path);
    document.remarks = document.animation.warnings;
    document.source_face.resize(document.animation.rest.face_count());
    std::iota(document.source_face.begin(), document.source_face.end(), 0u);
    document.source_face_count = document.source_face.size();
    return document;
}

}  // namespace

Document read_document(const fs::path& path) {
    if (!fs::exists(path))
        throw DataError(fmt::format("{}: there is no such file{}", path.string(), suggest_file(path)));
    if (fs::is_directory(path)) return document_of_animation(path);
    const std::string extension = lower_extension(path);
    if (extension != ".glb" && extension != ".gltf") return document_of_mesh(path);
    // A glTF file may hold a mesh that nothing moves.
    try {
        return document_of_animation(path);
    } catch (const MeshError& not_animated) {
        try {
            return document_of_mesh(path);
        } catch (const MeshError&) {
            throw not_animated;
        }
    }
}

void add_labels(Document& document, const fs::path& path) {
    if (lower_extension(path) == ".seg")
        color_by(document, segments_as_labels(read_seg(path, document.source_face_count)));
    else
        color_by(document, read_labels_txt(path, document.source_face_count));
}

}  // namespace exemplar
