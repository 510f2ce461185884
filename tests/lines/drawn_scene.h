#pragma once

#include <cmath>
#include <span>
#include <utility>

#include "host/lines/drawing.h"
#include "tests/lines/extraction/measured_surface.h"
#include "tests/support/shapes.h"

namespace exemplar::test_support {

constexpr int k_size = 400;  // pixels of pictures, both ways

struct Scene : MeasuredSurface {
    StrokeView view;

    explicit Scene(TriangleMesh shape, const Vec3& direction = {3, 2, 4}) : MeasuredSurface(std::move(shape)) {
        view.camera = fit_camera(mesh, direction, 1);
        view.width = view.height = k_size;
        view.unit_depth = view.camera.position().norm();
        view.feature_size = feature_size(mesh.vertices, curvature);
    }
};

/// Bumps and hollows that hide parts of each other.
inline TriangleMesh knobbly(int subdivisions) {
    return shapes::transformed(shapes::icosphere(subdivisions, 1), [](const Vec3& p) -> Vec3 {
        return p * (1 + 0.35f * std::sin(4 * p.x() + 1) * std::cos(3.5f * p.y()) + 0.15f * std::sin(5 * p.z()));
    });
}

inline Drawing draw(const Scene& scene, const DrawingStyle& style, std::span<const LineType> types = k_line_types) {
    return draw_lines(scene.surface(), types, style, scene.view);
}

inline LineStyle black() {
    LineStyle style;
    style.color = {0, 0, 0};
    return style;
}

}  // namespace exemplar::test_support
