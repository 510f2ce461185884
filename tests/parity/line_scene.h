#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>
#include <vector>

#include "gpu/lines/chains.h"
#include "gpu/lines/extraction.h"
#include "gpu/lines/segment_records.h"
#include "host/lines/strokes/chains.h"
#include "shaders/shared/lines.h"
#include "tests/gpu/support/environment.h"
#include "tests/lines/extraction/measured_surface.h"
#include "tests/parity/surfaces.h"

/// Surfaces, and the lines that the device finds on them, for the parity tests of lines.
namespace exemplar::test_support {

using shared::LineCounts;
using shared::LinePoint;
using shared::LineSegmentRecord;
using shared::vec4;

/// Devices that kernels see few texels on (SwiftShader: 65536) get smaller surfaces and pictures.
inline bool sees_few_texels() {
    return shared_device().info().max_texels < 800 * 600;
}
inline int picture_width() {
    return sees_few_texels() ? 280 : 800;
}
inline int picture_height() {
    return sees_few_texels() ? 210 : 600;
}
inline float picture_aspect() {
    return static_cast<float>(picture_width()) / static_cast<float>(picture_height());
}

/// A surface with estimated curvature, on both sides.
struct Scene : MeasuredSurface {
    GpuSurface device_surface;
    GpuLineSurface line_surface;
    Buffer vertices, device_normals, first, second, derivative;

    explicit Scene(TriangleMesh given, bool cut = false)
        : MeasuredSurface(std::move(given), cut),
          device_surface(shared_device(), mesh),
          line_surface(device_surface, neighbors, joined) {
        bring();
    }
    /// The same faces, elsewhere.
    void move(std::vector<Vec3> to) {
        mesh.vertices = std::move(to);
        measure();
        bring();
    }
    /// To the device.
    void bring() {
        vertices = upload_vertices(shared_device(), mesh.vertices);
        device_normals = upload(normals, std::vector<float>(mesh.vertex_count(), 0));
        first = upload(curvature.e1, curvature.k1);
        second = upload(curvature.e2, curvature.k2);
        std::vector<vec4> derivatives;
        for (const auto& [a, b, c, d] : curvature.derivative) derivatives.push_back({a, b, c, d});
        derivative = Buffer::of<vec4>(shared_device(), derivatives);
    }
    static Buffer upload(const std::vector<Vec3>& vectors, const std::vector<float>& last) {
        std::vector<vec4> out;
        for (std::size_t i = 0; i < vectors.size(); ++i)
            out.push_back({vectors[i].x(), vectors[i].y(), vectors[i].z(), last[i]});
        return Buffer::of<vec4>(shared_device(), out);
    }
    GpuCurvedSurface snapshot() const { return {vertices, device_normals, &first, &second, &derivative}; }
    float size() const { return feature_size(mesh.vertices, curvature); }
};

inline TriangleMesh lumpy() {
    return shapes::transformed(shapes::icosphere(sees_few_texels() ? 4 : 5, 1), [](const Vec3& p) -> Vec3 {
        return p * (1 + 0.2f * std::sin(3 * p.x() + 1) + 0.15f * p.y() * std::cos(4 * p.z()));
    });
}

/// Hollows, boundaries and creases.
inline TriangleMesh mixed() {
    const TriangleMesh round =
        shapes::joined(waved(shapes::torus(3, 1, 61, 23), 0.2f), shapes::translated(lumpy(), Vec3(0, 0, 3)));
    return shapes::joined(round,
                          shapes::joined(shapes::translated(shapes::box(2, 2, 2, 3), Vec3(4, 1, 3)),
                                         shapes::translated(shapes::cylinder(1, 2, 20, 5, false), Vec3(4, 5, 1))));
}

inline GpuLineOptions on_device(const LineOptions& options) {
    return {.eye = {options.eye.x(), options.eye.y(), options.eye.z(), options.parallel_eye ? 0.0f : 1.0f},
            .feature_size = options.feature_size,
            .thresholds = family_thresholds(options.thresholds)};
}

struct Found {
    LineCounts counts;
    std::vector<LineSegmentRecord> segments;
};

inline Found extract_on_device(const Scene& scene, GpuLineExtraction& lines, std::uint32_t families,
                               const LineOptions& options) {
    Stream stream(shared_device());
    lines.record(stream, scene.snapshot(), families, on_device(options));
    stream.finish();
    Found found{};
    lines.counts().download(std::span(&found.counts, 1));
    found.segments.resize(found.counts.segments);
    lines.segments().download(std::span(found.segments));
    return found;
}

using exemplar::family_of;
inline std::uint32_t family_of(LineType type, const LineSegment& segment) {
    if (type == LineType::contours && runs_along_edge(type, segment)) return shared::k_edge_contours;
    const LineType types[] = {type};
    const std::uint32_t families = line_families(types);
    return static_cast<std::uint32_t>(std::countr_zero(families)) + segment.family;
}

}  // namespace exemplar::test_support
