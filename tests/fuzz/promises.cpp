#include "tests/fuzz/promises.h"

#include <algorithm>

#include "host/core/errors.h"
#include "host/core/text.h"
#include "host/mesh/io_formats.h"
#include "host/mesh/validate.h"

namespace exemplar::fuzz {
namespace {

void require_faces(const TriangleMesh& mesh) {
    for (const Face& face : mesh.faces)
        for (std::uint32_t corner : face) require(corner < mesh.vertex_count(), "corners are vertices");
    if (mesh.source_face.empty()) {
        require(mesh.faces.empty() || mesh.source_face_count == mesh.face_count(), "each triangle is a source face");
    } else {
        require(mesh.source_face.size() == mesh.face_count(), "a source face per triangle");
        require(std::ranges::is_sorted(mesh.source_face), "source faces in the file's order");
        require(mesh.source_face.back() < mesh.source_face_count, "source faces within their number");
    }
}

void require_labels(const TriangleMesh& mesh, const FaceLabels& labels) {
    require(labels.label.size() == mesh.source_face_count, "a label per source face");
    try {
        mesh_io::check_labels(mesh, labels);
    } catch (const Error& error) {
        throw BrokenPromise(std::string("labels that can be written: ") + error.what());
    }
}

void require_report(const TriangleMesh& mesh) {
    const MeshReport report = validate_mesh(mesh);
    for (const std::string& message : report.messages()) require_readable(message);
    const bool finite = std::ranges::all_of(mesh.vertices, [](const Vec3& p) { return p.allFinite(); });
    require(report.usable() == (finite && !mesh.faces.empty()), "the report tells whether a mesh is usable");
    bool usable = true;
    try {
        require_usable(mesh, "x");
    } catch (const MeshError& error) {
        usable = false;
        require_readable(error.what());
    }
    require(usable == report.usable(), "what is not usable is refused");
}

}  // namespace

void require(bool kept, std::string_view promise) {
    if (!kept) throw BrokenPromise("broken promise: " + std::string(promise));
}

void require_readable(std::string_view message) {
    constexpr std::size_t k_longest = 600;
    const std::string shown(message.substr(0, k_longest));
    require(!message.empty() && message.size() <= k_longest, "a message of reasonable length: " + shown);
    require(is_utf8(message), "a message in UTF-8: " + shown);
    const auto is_control = [](char c) { return (c >= 0 && c < ' ') || c == '\x7f'; };
    require(std::ranges::none_of(message, is_control), "a message in one line, without control characters: " + shown);
}

void require_promises(const MeshFile& file) {
    require_faces(file.mesh);
    if (file.labels) require_labels(file.mesh, *file.labels);
    for (const std::string& warning : file.warnings) require_readable(warning);
    require_report(file.mesh);
}

}  // namespace exemplar::fuzz
