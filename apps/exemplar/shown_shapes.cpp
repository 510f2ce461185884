#include "apps/exemplar/shown_shapes.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "host/core/errors.h"
#include "host/mesh/editing/simplify.h"
#include "host/mesh/editing/weld.h"
#include "host/mesh/io/io.h"
#include "host/mesh/queries/point_tree.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

/// Maximum size of a file; one of two million faces is smaller. A larger file is not the one that the catalog
/// describes.
constexpr std::uintmax_t k_max_bytes = 64 << 20;

bool is_finite(const TriangleMesh& mesh) {
    return std::ranges::all_of(mesh.vertices, [](const Vec3& vertex) { return vertex.allFinite(); });
}

/// Converts labels and confidences from the file's faces to triangles; returns nothing if a face has none.
std::optional<ShownShape> per_triangle(MeshFile file) {
    if (!file.labels || file.confidence.empty() || !is_finite(file.mesh)) return {};
    ShownShape shape{std::move(file.mesh), {std::move(file.labels->names), {}}, {}};
    for (std::uint32_t f = 0; f < shape.mesh.face_count(); ++f) {
        const std::uint32_t source = shape.mesh.source_of(f);
        shape.labels.label.push_back(file.labels->label[source]);
        shape.confidence.push_back(file.confidence[source]);
        const bool labeled = shape.labels.label.back() >= 0;
        if (!labeled || !(shape.confidence.back() >= 0 && shape.confidence.back() <= 1)) return {};
    }
    return shape;
}

/// Sums over the original faces that each simplified face replaces.
struct Votes {
    std::vector<double> area, sure;  ///< per face; confidence times area
    std::vector<double> label;       ///< per face and label, area
};

Votes collect_votes(const ShownShape& shape, const SimplifiedMesh& simple) {
    const std::size_t faces = simple.mesh.face_count(), classes = shape.labels.names.size();
    Votes votes{std::vector<double>(faces, 0), std::vector<double>(faces, 0), std::vector<double>(faces * classes, 0)};
    const std::vector<float> areas = face_areas(shape.mesh);
    for (std::size_t f = 0; f < areas.size(); ++f) {
        const std::size_t to = simple.face_of[f];
        const double weight = areas[f] + 1e-30;  // faces without area count too
        votes.area[to] += weight;
        votes.sure[to] += weight * static_cast<double>(shape.confidence[f]);
        votes.label[to * classes + static_cast<std::size_t>(shape.labels.label[f])] += weight;
    }
    return votes;
}

/// Simplifies a shape. A simplified face that replaces no original face copies the nearest one.
ShownShape simplified(const ShownShape& shape, std::size_t max_faces) {
    SimplifiedMesh simple = simplify_mesh(welded(shape.mesh), max_faces);
    const Votes votes = collect_votes(shape, simple);
    const auto classes = static_cast<std::ptrdiff_t>(shape.labels.names.size());
    const PointTree originals(face_centers(shape.mesh));
    const std::vector<Vec3> centers = face_centers(simple.mesh);
    ShownShape result{std::move(simple.mesh), {shape.labels.names, {}}, {}};
    for (std::size_t f = 0; f < centers.size(); ++f) {
        const auto first = votes.label.begin() + static_cast<std::ptrdiff_t>(f) * classes;
        const bool stands_for_some = votes.area[f] > 0;
        const std::uint32_t nearest = stands_for_some ? 0 : originals.nearest(centers[f]);
        result.labels.label.push_back(stands_for_some
                                          ? static_cast<std::int32_t>(std::max_element(first, first + classes) - first)
                                          : shape.labels.label[nearest]);
        result.confidence.push_back(stands_for_some ? static_cast<float>(votes.sure[f] / votes.area[f])
                                                    : shape.confidence[nearest]);
    }
    return result;
}

}  // namespace

std::optional<ShownShape> read_shown_shape(const fs::path& path, std::size_t max_faces) {
    std::error_code unreadable;
    if (!fs::is_regular_file(path, unreadable) || fs::file_size(path, unreadable) > k_max_bytes) return {};
    try {
        std::optional<ShownShape> shape = per_triangle(read_mesh(path));
        if (shape && shape->mesh.face_count() > max_faces) shape = simplified(*shape, max_faces);
        // A soup of separate pieces may keep more faces than that.
        if (shape && shape->mesh.face_count() > 2 * max_faces) return {};
        return shape;
    } catch (const MeshError&) {
        return {};
    }
}

}  // namespace exemplar
