#include "tests/fuzz/support/promises.h"

#include <algorithm>
#include <cmath>

#include "host/core/errors.h"
#include "host/core/text.h"
#include "host/mesh/editing/validate.h"
#include "host/mesh/io/io_formats.h"

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
    require(usable == (report.usable() && size_fault(mesh, k_usable_sizes).empty()), "what is not usable is refused");
}

void require_rig(const Rig& rig, std::size_t vertex_count) {
    for (std::size_t i = 0; i < rig.nodes.size(); ++i)
        require(rig.nodes[i].parent == k_invalid_index || rig.nodes[i].parent < i, "parents before children");
    for (const Bone& bone : rig.bones) require(bone.node < rig.nodes.size(), "bones are nodes");
    require(rig.influence_begin.size() == vertex_count + 1, "influences of each vertex");
    for (std::size_t v = 0; v < vertex_count; ++v) {
        float sum = 0;
        const auto row = rig.influences_of(v);
        require(!row.empty(), "an influence at least");
        for (std::size_t i = 0; i < row.size(); ++i) {
            require(row[i].bone < rig.bones.size(), "influences are bones'");
            require(i == 0 || row[i - 1].bone < row[i].bone, "bones rise");
            require(row[i].weight > 0 && row[i].weight <= 1, "weights in (0, 1]");
            sum += row[i].weight;
        }
        require(std::abs(sum - 1) < 1e-4f, "weights sum to one");
    }
    for (const MorphTarget& target : rig.targets) {
        require(target.vertices.size() == target.offsets.size(), "an offset per vertex");
        for (std::size_t i = 0; i < target.vertices.size(); ++i)
            require(target.vertices[i] < vertex_count && (i == 0 || target.vertices[i - 1] < target.vertices[i]),
                    "vertices of a target rise");
    }
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

void require_promises(const Animation& animation) {
    require_faces(animation.rest);
    require(!animation.rest.faces.empty(), "a surface has faces");
    if (animation.has_rig()) require_rig(animation.rig, animation.rest.vertex_count());
    for (const std::uint32_t v : animation.vertex_of_source)
        require(v < animation.rest.vertex_count(), "vertices of the file are vertices");
    for (const std::string& warning : animation.warnings) require_readable(warning);
    for (const Clip& clip : animation.clips) {
        require(clip.size() > 0, "a clip has frames");
        require(frame_vertices(animation, clip, clip.size() - 1).size() == animation.rest.vertex_count(),
                "a frame has the surface's vertices");
    }
}

}  // namespace exemplar::fuzz
