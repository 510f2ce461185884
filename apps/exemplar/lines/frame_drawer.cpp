#include "apps/exemplar/lines/frame_drawer.h"

#include "gpu/lines/device_style.h"
#include "gpu/lines/face_types.h"

namespace exemplar {
namespace {

CurvatureOptions measured_curvature(const LinesJob& job, const LinesSource& source) {
    if (source.model()) return source.model()->truth;
    return {.derivatives = true, .smoothing = job.source.measuring.smoothing};
}

}  // namespace

FrameDrawer::FrameDrawer(const LinesJob& job, LinesSource& source, const StrokeView& view)
    : source_(source),
      device_({.name = job.common.device}),
      renderer_(device_, source.animation(), measured_curvature(job, source),
                source.model() ? &*source.model() : nullptr),
      stream_(device_) {
    const DeviceStyle style = device_style(job.style);
    renderer_.view().set_textures(style.textures);
    picture_.view = view;
    apply_style(style, job.types, picture_);
}

Image FrameDrawer::draw(std::size_t frame) {
    return draw(frame, source_.model() ? CurvatureSource::learned : CurvatureSource::estimated);
}

Image FrameDrawer::draw(std::size_t frame, CurvatureSource from) {
    renderer_.record(stream_, source_.frames()[frame], from);
    Image image = renderer_.view().render(stream_, renderer_.snapshot(), picture_);
    flicker_.push_back(renderer_.view().coherence().flicker());
    return image;
}

LineFlicker FrameDrawer::flicker() const {
    LineFlicker mean;
    for (std::size_t i = 1; i < flicker_.size(); ++i) {
        const float share = 1 / static_cast<float>(flicker_.size() - 1);
        mean.drawn += share * flicker_[i].drawn;
        mean.appeared += share * flicker_[i].appeared;
        mean.slip += share * flicker_[i].slip;
        mean.stretch += share * flicker_[i].stretch;
    }
    return mean;
}

FaceTypes FrameDrawer::face_types() {
    return download_face_types(renderer_.view().strokes().chains().lines());
}

FaceTypes FrameDrawer::face_types_from(const Vec3& eye) {
    if (!elsewhere_) elsewhere_.emplace(renderer_.line_surface());
    elsewhere_->record(stream_, renderer_.snapshot(), picture_.families,
                       {.eye = {eye.x(), eye.y(), eye.z(), 1},
                        .feature_size = picture_.view.feature_size,
                        .thresholds = picture_.thresholds});
    stream_.finish();
    return download_face_types(*elsewhere_);
}

}  // namespace exemplar
