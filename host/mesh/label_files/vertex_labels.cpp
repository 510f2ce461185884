#include "host/mesh/label_files/vertex_labels.h"

#include <Eigen/Geometry>
#include <cmath>
#include <map>

#include "host/mesh/io/io_formats.h"
#include "host/mesh/topology.h"

namespace exemplar {
namespace {

/// The angle of a triangle at a corner, radians; 0 if it has no sides there.
double corner_angle(const TriangleMesh& mesh, const Face& face, std::size_t corner) {
    const Vec3d at = mesh.vertices[face[corner]].cast<double>();
    const Vec3d a = mesh.vertices[face[(corner + 1) % 3]].cast<double>() - at;
    const Vec3d b = mesh.vertices[face[(corner + 2) % 3]].cast<double>() - at;
    const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
    return std::isfinite(angle) ? angle : 0;
}

/// Votes of one vertex or face for labels.
struct LabelVotes {
    std::map<std::int32_t, double> weight;

    std::int32_t winner() const {
        std::int32_t best = -1;
        double most = -1;
        for (const auto& [label, sum] : weight)
            if (sum > most) most = sum, best = label;
        return best;
    }
};

std::vector<std::int32_t> winners(const std::vector<LabelVotes>& votes) {
    std::vector<std::int32_t> labels;
    labels.reserve(votes.size());
    for (const LabelVotes& vote : votes) labels.push_back(vote.winner());
    return labels;
}

}  // namespace

std::vector<std::int32_t> labels_of_vertices(const TriangleMesh& mesh, std::span<const std::int32_t> face_label) {
    std::vector<LabelVotes> votes(mesh.vertex_count());
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        const std::int32_t label = face_label[mesh.source_of(f)];
        if (label < 0) continue;
        for (std::size_t i = 0; i < 3; ++i)
            votes[mesh.faces[f][i]].weight[label] += corner_angle(mesh, mesh.faces[f], i);
    }
    return winners(votes);
}

std::vector<std::int32_t> labels_of_faces(const TriangleMesh& mesh, std::span<const std::int32_t> vertex_label) {
    constexpr double k_angle_weight = 1e-3;  // of a triangle at most 1e-3 pi, less than a corner
    std::vector<LabelVotes> votes(mesh_io::source_faces(mesh));
    std::vector<std::uint32_t> counted_in(mesh.vertex_count(),
                                          k_invalid_index);  // triangles share corners of a polygon
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::int32_t label = vertex_label[mesh.faces[f][i]];
            if (label < 0) continue;
            std::uint32_t& counted = counted_in[mesh.faces[f][i]];
            const double corner = counted == mesh.source_of(f) ? 0 : 1;
            counted = mesh.source_of(f);
            votes[counted].weight[label] += corner + k_angle_weight * corner_angle(mesh, mesh.faces[f], i);
        }
    return winners(votes);
}

}  // namespace exemplar
