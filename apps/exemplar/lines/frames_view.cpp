#include "apps/exemplar/lines/frames_view.h"

#include "host/lines/extraction/lines.h"
#include "host/mesh/curvature/curvature.h"

namespace exemplar {

StrokeView view_of_frames(const Animation& animation, std::span<const FrameRef> frames, int width, int height) {
    TriangleMesh first = animation.rest, all;
    for (const FrameRef& at : frames) {
        std::vector<Vec3> vertices = frame_vertices(animation, animation.clips[at.clip], at.frame);
        all.vertices.insert(all.vertices.end(), vertices.begin(), vertices.end());
        if (&at == &frames.front()) first.vertices = std::move(vertices);
    }
    StrokeView view;
    view.width = width;
    view.height = height;
    view.camera = fit_camera(all, Vec3(0.5f, 0.3f, 1), static_cast<float>(width) / static_cast<float>(height));
    view.feature_size = feature_size(first.vertices, estimate_curvature(first, false));
    view.unit_depth = (view.camera.position() - area_centroid(first)).norm();
    return view;
}

}  // namespace exemplar
