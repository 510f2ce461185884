#include "apps/exemplar/frame_drawer.h"

#include "gpu/lines/device_style.h"
#include "gpu/lines/face_types.h"

namespace exemplar {
namespace {

CurvatureOptions measured_curvature(const LinesJob& job, const LinesSource& source) {
    if (source.model()) return source.model()->truth;
    return {.derivatives = true, .smoothing = job.source.smoothing};
}

}  // namespace

FrameDrawer::FrameDrawer(const LinesJob& job, LinesSource& source, const StrokeView& view)
    : source_(source),
      device_({.name = job.common.device}),
      surface_(device_, source.animation().rest),
      line_surface_(surface_),
      moving_(surface_, source.animation().rig, measured_curvature(job, source)),
      renderer_(device_, line_surface_),
      stream_(device_) {
    if (source.model()) moving_.set_model(*source.model());
    const DeviceStyle style = device_style(job.style);
    renderer_.set_textures(style.textures);
    picture_.view = view;
    apply_style(style, job.types, picture_);
}

GpuCurvedSurface FrameDrawer::moment() const {
    const auto [first, second, derivative] = moving_.curvature();
    return {moving_.vertices(), moving_.normals(), first, second, derivative};
}

Image FrameDrawer::draw(std::size_t frame) {
    return draw(frame, source_.model() ? CurvatureSource::learned : CurvatureSource::estimated);
}

Image FrameDrawer::draw(std::size_t frame, CurvatureSource from) {
    const FrameRef at = source_.frames()[frame];
    const Clip& clip = source_.animation().clips[at.clip];
    if (clip.poses.empty())
        moving_.record(stream_, clip.frames[at.frame], from);
    else
        moving_.record(stream_, clip.poses[at.frame], from);
    return renderer_.render(stream_, moment(), picture_);
}

FaceTypes FrameDrawer::face_types() const {
    return download_face_types(renderer_.strokes().chains().lines());
}

FaceTypes FrameDrawer::face_types_from(const Vec3& eye) {
    if (!elsewhere_) elsewhere_.emplace(line_surface_);
    elsewhere_->record(stream_, moment(), picture_.families,
                       {.eye = {eye.x(), eye.y(), eye.z(), 1},
                        .feature_size = picture_.view.feature_size,
                        .thresholds = picture_.thresholds});
    stream_.finish();
    return download_face_types(*elsewhere_);
}

}  // namespace exemplar
