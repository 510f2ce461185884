#include "host/hatching/features/line_directions.h"

#include <complex>

#include "host/mesh/curvature/tangent_tensors.h"

namespace exemplar {

LineSurface line_surface(const HatchingSurface& surface) {
    return {surface.mesh.faces, surface.mesh.vertices, surface.normals, surface.line_curvature, surface.neighbors};
}

std::vector<Vec3> complete_line_directions(const DirectionSmoother& smoother, const HatchingSurface& surface,
                                           std::span<const LineSegment> segments) {
    const std::size_t count = surface.mesh.vertex_count();
    // Sums of doubled angles weighted by segment length: opposite directions add up, perpendicular ones cancel.
    std::vector<std::complex<float>> sums(count);
    std::vector<float> lengths(count);
    for (const LineSegment& segment : segments) {
        const Face& face = surface.mesh.faces[segment.face];
        Vec3 way = Vec3::Zero();
        for (std::size_t k = 0; k < 3; ++k)
            way += (segment.ends[1][k] - segment.ends[0][k]) * surface.mesh.vertices[face[k]];
        for (const std::uint32_t v : face) {
            const TangentFrame frame = frame_of_normal(surface.normals[v]);
            const std::complex<float> z(frame.tangent.dot(way), frame.bitangent.dot(way));
            const float length = std::abs(z);
            if (!(length > 0)) continue;
            sums[v] += z * z / length;
            lengths[v] += length;
        }
    }
    std::vector<Vec3> directions(count, Vec3::Zero());
    std::vector<float> confidence(count);
    for (std::size_t v = 0; v < count; ++v) {
        if (!(lengths[v] > 0) || !(std::abs(sums[v]) > 0)) continue;
        const std::complex<float> half = std::sqrt(sums[v]);
        const TangentFrame frame = frame_of_normal(surface.normals[v]);
        directions[v] = half.real() * frame.tangent + half.imag() * frame.bitangent;
        confidence[v] = direction_confidence(std::abs(sums[v]) / lengths[v]);
    }
    return smoother.complete(directions, confidence);
}

std::vector<Vec3> complete_line_directions(const DirectionSmoother& smoother, const HatchingSurface& surface,
                                           LineType type) {
    LineOptions options;
    options.feature_size = surface.feature_size;
    options.eye = Vec3::UnitZ();
    options.parallel_eye = true;
    return complete_line_directions(smoother, surface, extract_lines(line_surface(surface), type, options));
}

}  // namespace exemplar
